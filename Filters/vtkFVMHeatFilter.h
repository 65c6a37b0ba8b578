// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFVMHeatFilter
 * @brief   linear diffusion of data on a triangulated surface
 *
 * Solves the heat equation of the Laplace-Beltrami operator, with anisotropic diffusion and
 * fidelity as options,
 *
 *     u_t = div(g1 (grad u . e1) e1 + g2 (grad u . e2) e2) + lambda chi (f - u),   u(0) = f,
 *
 * by the finite volume method of C. Wu, J. Deng and F. Chen (IEEE TVCG 14(3), 2008): cotan weights,
 * a lumped mass matrix and implicit time steps. chi is the indicator of the known part: 0 where
 * data are missing, 1 elsewhere. The boundary condition is the homogeneous Neumann condition. The
 * special cases are the paper's (1) smoothing (lambda = 0, g1 = g2), (4) anisotropic smoothing
 * along a direction field, (16) denoising (lambda > 0) and (18) inpainting (missing data). Each
 * component of the data diffuses independently of the others, unless they are tangent vectors.
 *
 * Diffusion for time t is a Gaussian blur of full width at half maximum 4 sqrt(t ln 2), regardless
 * of the triangulation. The property FWHM sets that width directly, and white noise of the variance
 * 1/A_i gets it to 5 % from 2 mean edge lengths on, to 10 % from 1.5; below that a warning comes.
 *
 * The unit of time in natural units is h^2 (h the mean edge length). Diffusivities have no unit,
 * and lambda is in 1/h^2. The semi-discrete equation is
 *
 *     A_i du_i/dt = sum over triangles and j of c_ij u_j + A_i lambda chi_i (f_i - u_i),
 *
 * with the barycentric control areas A_i (the lumped mass matrix) and the weights c_ij of (10),
 * the cotan weights, and of (13). Without fidelity, fixed or held values, the sum of A_i u_i is
 * conserved to a relative error of 1e-12.
 *
 * With MassMatrix Mixed, (B du/dt)_i stands on the left, where B is the mean of the lumped and of the
 * consistent mass matrix, a sixth and a twelfth of the area of each triangle. On an even lattice of
 * edges h, waves of the wave number k have the eigenvalue k^2 (1 - k^2 h^2/16) with the lumped one:
 * white noise gets .74, .77, .90 and .95 of a width of 1.5, 2, 3 and 4 mean edge lengths. With the
 * mixed one the error is of fourth order: .91, .96, 1.00 and 1.00. A single peak leaves up to 0.6 % of
 * it below its surroundings at widths of 1.5 edges. Automatic (the default) is Mixed with FWHM, and
 * Lumped otherwise.
 *
 * TimeIntegrator Automatic (the default) is Exponential with FWHM, and SecondOrder otherwise.
 * SecondOrder is SDIRK2 with gamma = 1 - 1/sqrt(2) (R. Alexander, SIAM
 * J. Numer. Anal. 14, 1977). It is L-stable and solves two systems with one matrix per step. For an
 * error of 1e-3 it takes 3 to 4 steps; FirstOrder, backward Euler as in (8) and (14), takes about
 * 100. Backward Euler keeps the bounds of the data on Delaunay meshes at any time step, SDIRK2 only
 * at small time steps. Exponential gives what the heat equation does to the data in one step of any
 * length: a polynomial of degree 6 in a step of backward Euler (one pole: S. Norsett, SIAM J.
 * Numer. Anal. 15, 1978), six solves with one matrix. The variance of its kernel is exact. The
 * error is at most 0.14 % of an eigenfunction as it was before the step, and 0.5 % (root mean
 * square) of the result for white noise, where three steps of SecondOrder, of six solves, too, are
 * off by 7 %. Data on cells are off by up to 1 %. It keeps the range of the data up to 5e-4 of it,
 * but for triangles with obtuse angles at boundaries.
 * One FirstOrder step of 2/k^2 is the implicit filter by scale of order 1, (1 - 2/k^2 Laplace) u =
 * f, which leaves a third of waves of the wave number k.
 *
 * With VectorType Tangent, three components are a vector u in the tangent plane: orthogonal to the
 * normal of N. Max (J. Graphics Tools 4(2), 1999), two unknowns at each vertex. With the projector P of
 * a triangle's plane, G = P (sum over its vertices of u_j grad(phi_j)^T) P is the covariant derivative
 * there, and VectorLaplacian chooses the energy whose gradient stands in place of the Laplacian. On the
 * unit sphere gradients and curls of degree l, with d = l (l + 1), decay at the rates
 *
 *     Connection   1/2 int G:G                              d - 1 both
 *     Hodge        1/2 int (tr G)^2 + (G12 - G21)^2         d both
 *     Viscous      int sym G : sym G                        2 d - 2 and d - 2
 *
 * up to an error of second order in h. Viscous keeps rigid rotations to round-off. Results at cells are
 * in their planes. At edges of three or more triangles there is no tangent plane: that of two of the
 * sheets is taken, by the numbering.
 *
 * The energy in the history is 1/2 int (g1 (grad u . e1)^2 + g2 (grad u . e2)^2) + lambda/2
 * int chi (u - f)^2, summed over the components, in (units of the array)^2.
 *
 * @sa vtkIntrinsicTVFilter vtkHarmonicMapFilter vtkTuringTextureFilter
 */
#ifndef vtkFVMHeatFilter_h
#define vtkFVMHeatFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkFVMHeatFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkFVMHeatFilter* New();
  vtkTypeMacro(vtkFVMHeatFilter, vtkSurfaceDataDiffusionAlgorithm);

  enum ModeType
  {
    MODE_TIME_STEPS = 0,
    MODE_STEADY_STATE = 1
  };

  ///@{
  /**
   * TimeSteps (default): NumberOfTimeSteps steps of TimeStep. SteadyState: the limit of infinite
   * time, computed by one solve, without times. It is the harmonic inpainting with fixed
   * or held values, the minimiser of the energy with lambda, and the mean of each connected
   * component with neither.
   */
  SURFACEDIFFUSION_CHOICE(Mode);
  void SetModeToTimeSteps() { this->SetMode(MODE_TIME_STEPS); }
  void SetModeToSteadyState() { this->SetMode(MODE_STEADY_STATE); }
  ///@}

  /**
   * The full width at half maximum of the Gaussian that the data are convolved with, in coordinate
   * units; 0 (default): off. If it is set, the run takes the time FWHM^2/(16 ln 2) in
   * NumberOfTimeSteps equal steps in place of TimeStep, and times are in coordinate units squared
   * regardless of Units. FWHM is an error together with a fidelity, diffusivities other than 1, or
   * Mode SteadyState.
   */
  SURFACEDIFFUSION_PROPERTY(FWHM, double);

  /**
   * On: lambda is chosen so that the estimated error of the steady state of (16) is smallest (see
   * RiskSearch): the unbiased risk (C. Stein, Annals of Statistics 9, 1981),
   *
   *     mean of w (u - f)^2 + 2 s^2 (mean of du_i/df_i),
   *
   * with the noise s, area-weighted, where the derivatives are along a random direction of up to 8
   * (M. Hutchinson 1990), and outliers have a noise of their own. Where the data differ from u by
   * more than s accounts for, at jumps or with uneven noise, it is generalised cross-validation (P.
   * Craven, G. Wahba, Numerische Mathematik 31, 1979), which needs no s. Where the noise is
   * correlated, NoiseLevel is above the differences between neighbours, or BlurFWHM is set, the root
   * mean square of u - f is that of the noise (discrepancy principle, V. Morozov 1966), which errs on the smooth
   * side. For nine kinds of noise, four signals, and four surfaces the error was 1.01 times that of
   * the best lambda in the median, and at most 1.19 times in nine of ten cases. Constant parts of
   * the data, such as a background of 0, have no noise and are left out. FidelityWeight is ignored.
   * Default: off; with BlurFWHM and FidelityWeight 0 always on.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticFidelity);

  /**
   * The standard deviation of the noise for AutomaticFidelity, in the array's own units regardless
   * of Units. 0 or more. 0 (default): it is estimated from the median difference of each value from
   * a linear fit to its neighbours. The estimate assumes white noise, independent from point to
   * point. If points farther apart differ by 15 % more, as in data that were interpolated or
   * smoothed, the noise is correlated: a warning gives both values, and the larger is used.
   *
   * Noise that was smoothed with a Gaussian kernel of a standard deviation of 3 edges or more is as
   * smooth as a signal, and the estimate is too small. A warning then says that the data show no
   * white noise, and gives the deviation of the data, which is that of the noise if there is no
   * signal. A signal without noise gives the same warning, and so may white noise below a quarter
   * of the estimate under waves of less than 7 edges. No warning comes for correlated noise
   * together with white noise of half of the estimate, for fewer than about 300 points, and often
   * where the lengths of neighbouring edges differ much or the surface has many sharp edges.
   *
   * For data on cells it is the noise of the cells. The estimate assumes white noise on them, and
   * no warning comes.
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLevel, double);

  /**
   * The lambda of the last update, in the unit of FidelityWeight: FidelityWeight, or the value that
   * AutomaticFidelity found. AutomaticFidelity finds one for each component and each
   * connected component of the surface, since each may have noise of its own: this is that of the
   * first component and the largest connected component. In composite data it is the value of the
   * first block, and each block has its own as field array `EffectiveFidelityWeight`, with
   * ResultArrayName as prefix.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveFidelityWeight, double);

  /**
   * The full width at half maximum of a blur that the data have gone through on the surface, in
   * coordinate units, regardless of Units, and that SteadyState removes; 0 (default): none. The
   * result is the minimiser of
   *
   *     1/2 int (g1 (grad u . e1)^2 + g2 (grad u . e2)^2) + lambda/2 int chi (H u - f)^2
   *
   * (Tikhonov regularisation), where H is the blur: BlurSteps steps of backward Euler for the heat
   * equation, whose point spread function on the plane has this width. It needs Mode SteadyState.
   * FidelityWeight 0, the default, then stands for the weight that AutomaticFidelity finds: a
   * restoration has no other weight that suits most data. Any other weight is used. A warning
   * reports a width outside 2 to 8 mean edge lengths. A camera blurs in its image, not on the
   * surface: its point spread function differs from H where the surface is oblique.
   */
  SURFACEDIFFUSION_PROPERTY(BlurFWHM, double);

  /**
   * The number of steps of the blur of BlurFWHM, 2 to 64. With 4, the default, its point spread
   * function has the half maximum of a Gaussian but longer tails: if the blur was that of heat
   * flow, waves of 1 to 2 widths come back up to half too high. More steps are more similar to a
   * Gaussian, and amplify noise more: 64 restore waves of 1.5 widths to 2 %.
   */
  SURFACEDIFFUSION_PROPERTY(BlurSteps, int);

  ///@{
  /**
   * The time integrator, see the class comment. FirstOrder is the paper's; SecondOrder does not
   * keep the bounds of the data at large time steps, nor does Exponential, which is the most
   * accurate one for few steps. Automatic (default): Exponential with FWHM, SecondOrder otherwise.
   * Fewer than 4 steps of another one than Exponential to a FWHM are a warning. Implicit is an
   * error.
   */
  SURFACEDIFFUSION_CHOICE(TimeIntegrator);
  void SetTimeIntegratorToFirstOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_FIRST_ORDER); }
  void SetTimeIntegratorToSecondOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_SECOND_ORDER); }
  void SetTimeIntegratorToExponential() { this->SetTimeIntegrator(TIME_INTEGRATOR_EXPONENTIAL); }
  void SetTimeIntegratorToAutomatic() { this->SetTimeIntegrator(TIME_INTEGRATOR_AUTOMATIC); }
  ///@}

  enum MassMatrixType
  {
    MASS_MATRIX_AUTOMATIC = 0,
    MASS_MATRIX_LUMPED = 1,
    MASS_MATRIX_MIXED = 2
  };

  ///@{
  /**
   * The mass matrix, see the class comment. Lumped is the paper's. Automatic (default): Mixed with
   * FWHM, Lumped otherwise. No effect on a steady state.
   */
  SURFACEDIFFUSION_CHOICE(MassMatrix);
  void SetMassMatrixToAutomatic() { this->SetMassMatrix(MASS_MATRIX_AUTOMATIC); }
  void SetMassMatrixToLumped() { this->SetMassMatrix(MASS_MATRIX_LUMPED); }
  void SetMassMatrixToMixed() { this->SetMassMatrix(MASS_MATRIX_MIXED); }
  ///@}

  /**
   * The period P of cyclic data f, such as 360 for angles in degrees, in the unit of the data; 0
   * (default): none. The filter diffuses the unit vectors (cos, sin)(2 pi f/P), which do not jump where
   * f does. The result is their angle in data units, in the interval of length P that starts at 0, or at
   * -P/2, or else at the minimum of the data, the first that holds all of them. A second array, with
   * Coherence in place of the suffix Diffused, has the lengths of the vectors, from 0 where they cancel
   * to 1 where they agree. Data with P added have the same result.
   */
  SURFACEDIFFUSION_PROPERTY(Period, double);

  enum VectorTypeType
  {
    VECTOR_TYPE_AUTOMATIC = 0,
    VECTOR_TYPE_COMPONENTS = 1,
    VECTOR_TYPE_TANGENT = 2
  };

  ///@{
  /**
   * How data of three components are taken. Components: as so many scalars. Tangent: as vectors in the
   * tangent plane of the surface, see the class comment; of 6, 9, ... components as several. It excludes
   * IntrinsicDelaunay, and a surface in pieces is solved by one process. Automatic (default): Tangent if
   * there are three components of floating-point numbers, and the vectors that are known and not 0 lie
   * within 5 degrees of the surface on nine tenths of it, by area, and are not the coordinates;
   * otherwise, and for large surfaces in pieces and with IntrinsicDelaunay, Components. A warning says
   * that it is Tangent, or that at least half of the vectors lie in the surface.
   */
  SURFACEDIFFUSION_CHOICE(VectorType);
  void SetVectorTypeToAutomatic() { this->SetVectorType(VECTOR_TYPE_AUTOMATIC); }
  void SetVectorTypeToComponents() { this->SetVectorType(VECTOR_TYPE_COMPONENTS); }
  void SetVectorTypeToTangent() { this->SetVectorType(VECTOR_TYPE_TANGENT); }
  ///@}

  enum VectorLaplacianType
  {
    VECTOR_LAPLACIAN_CONNECTION = 0,
    VECTOR_LAPLACIAN_HODGE = 1,
    VECTOR_LAPLACIAN_VISCOUS = 2
  };

  ///@{
  /**
   * The Laplacian of tangent vectors, see the class comment. Connection (default): for smoothing and
   * denoising. Hodge: for filters that commute with divergence and curl. Viscous: for flows. Hodge and
   * Viscous require diffusivities of 1.
   */
  SURFACEDIFFUSION_CHOICE(VectorLaplacian);
  void SetVectorLaplacianToConnection() { this->SetVectorLaplacian(VECTOR_LAPLACIAN_CONNECTION); }
  void SetVectorLaplacianToHodge() { this->SetVectorLaplacian(VECTOR_LAPLACIAN_HODGE); }
  void SetVectorLaplacianToViscous() { this->SetVectorLaplacian(VECTOR_LAPLACIAN_VISCOUS); }
  ///@}

  enum NormalPartType
  {
    NORMAL_PART_DROP = 0,
    NORMAL_PART_KEEP = 1,
    NORMAL_PART_DIFFUSE = 2
  };

  ///@{
  /**
   * What becomes of the part of tangent vectors along the normal. Drop (default): it is left out. Keep:
   * it stays as it is at the start. Diffuse: it is diffused as a scalar.
   */
  SURFACEDIFFUSION_CHOICE(NormalPart);
  void SetNormalPartToDrop() { this->SetNormalPart(NORMAL_PART_DROP); }
  void SetNormalPartToKeep() { this->SetNormalPart(NORMAL_PART_KEEP); }
  void SetNormalPartToDiffuse() { this->SetNormalPart(NORMAL_PART_DIFFUSE); }
  ///@}

  /**
   * In addition to the superclass: Mode TimeSteps, MassMatrix Lumped, VectorType Components.
   */
  void UsePaperScheme() override;

protected:
  vtkFVMHeatFilter();
  ~vtkFVMHeatFilter() override = default;

private:
  vtkFVMHeatFilter(const vtkFVMHeatFilter&) = delete;
  void operator=(const vtkFVMHeatFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
