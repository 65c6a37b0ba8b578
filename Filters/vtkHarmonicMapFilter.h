// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHarmonicMapFilter
 * @brief   regularise unit vectors on a triangulated surface: normals, directions, chromaticity
 *
 * Solves the heat flow of p-harmonic maps u from the surface into the unit sphere S^(m-1),
 *
 *     u_t = div(g grad u) + u g |grad u|^2 + lambda chi (f - u),   u(0) = f / |f|,   |u| = 1,
 *     g = (|grad u|^2 + beta)^((p - 2)/2),   |grad u|^2 the sum over all components,
 *
 * with finite volumes (cotan weights, lumped mass matrix), implicit steps in the tangent spaces and
 * normalisation. These are the models (20) with p = 2, (21) with p = 1 and all p between them of C.
 * Wu, J. Deng and F. Chen (IEEE TVCG 14(3), 2008). The number of components m is 2 or more. chi is
 * the indicator of the known part: 0 where data are missing, 1 elsewhere. The boundary condition is
 * the homogeneous Neumann condition. |u| = 1 holds to 1e-12 at every vertex. p = 2 smooths evenly,
 * whereas p = 1 smooths the faces of a surface and keeps its creases.
 *
 * **Data.** The default data are the surface's normals: the active ones, or, if there are none,
 * computed normals (not split at edges). Any other point or cell array of 2 or more components is
 * normalised on entry, so that only its direction counts. Vectors of length zero or with NaN are
 * missing and are filled in, as masked vectors are. If InitialFill is Mean but there is no
 * prevailing direction (the mean of the known unit vectors is shorter than 1/2, as it is for the
 * normals of a closed surface), missing vectors start from the values at the rim of their hole.
 * Colours (unsigned char) are regularised in chromaticity: with OutputPrecision Input the result is
 * a colour of the input's brightness |f|.
 *
 * The result becomes the active normals if UseAsNormals is on and the data are normals. It does not
 * become the active vectors as well, since ParaView does not shade with an array that is both.
 * Otherwise the result becomes the active vectors (if it has three components and is no colour) or
 * the active scalars.
 *
 * **Energy.** The energy in the history is
 *
 *     E = int ((|grad u|^2 + beta)^(p/2) - beta^(p/2)) / p + lambda/2 int chi |f - u|^2,
 *
 * in length^(2 - p). It is 4 pi for the identity of the sphere at p = 2. With AlongDiffusivity and
 * AcrossDiffusivity, which are the eigenvalues of the diffusion tensor D with the larger one d,
 * |grad u|^2 is replaced by grad u . D grad u / d in E and g, and the first integral is multiplied
 * by d.
 *
 * **Schemes.** TangentPlane (default) and MinimizingMovement never increase E, for any time step
 * and any triangles. Core/Models/Harmonic/HarmonicMap.h has the proof. In short, a step minimises
 * the energy with frozen g, an upper bound of E, over displacements orthogonal to u at every
 * vertex. Normalising then does not increase the distance of any two vectors. For negative weights,
 * which obtuse triangles cause, the same holds for a vector and the opposite of another one, after
 * the matrix has been made diagonally dominant there. The paper's splitting, ExplicitReaction, has
 * no such guarantee. On noisy normals TangentPlane and ExplicitReaction are equally accurate and
 * equally fast. At equal accuracy MinimizingMovement takes 3 to 5 times as long, but its result
 * depends least on the time step.
 *
 * The unit of time in natural units is h^p (h the mean edge length). beta is in 1/h^2, lambda in
 * 1/h^p. Normals with noise of 15 degrees are most accurate after a time of 0.2 to 0.4: here the
 * default of TimeStep is 0.1 and that of NumberOfTimeSteps 3.
 *
 * There is no second-order time integrator, and the sum of A_i u_i is not conserved.
 *
 * @sa vtkFVMHeatFilter vtkIntrinsicTVFilter vtkTuringTextureFilter vtkPolyDataNormals
 */
#ifndef vtkHarmonicMapFilter_h
#define vtkHarmonicMapFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkHarmonicMapFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkHarmonicMapFilter* New();
  vtkTypeMacro(vtkHarmonicMapFilter, vtkSurfaceDataDiffusionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The exponent p, in [1, 2]. 1 (default) is (21) and keeps creases; 2 is (20) and smooths evenly.
   */
  SURFACEDIFFUSION_PROPERTY(Exponent, double);

  /**
   * beta in |grad u|^2 + beta, in 1/length^2 (natural: 1/h^2). Above 0; 0 is allowed with Exponent
   * 2, for which beta has no effect. Default: 1e-6.
   */
  SURFACEDIFFUSION_PROPERTY(Beta, double);

  enum SchemeType
  {
    SCHEME_EXPLICIT_REACTION = 0,
    SCHEME_TANGENT_PLANE = 1,
    SCHEME_MINIMIZING_MOVEMENT = 2
  };

  ///@{
  /**
   * The scheme of a step. TangentPlane (default): one linear solve for displacements tangential to
   * the sphere, then normalisation; the energy never increases. MinimizingMovement: the same,
   * repeated until the backward Euler step is solved in full; the energy never increases.
   * ExplicitReaction: the paper's scheme, with semi-implicit diffusion of the components with one
   * matrix, explicit reaction, then normalisation.
   */
  SURFACEDIFFUSION_CHOICE(Scheme);
  void SetSchemeToExplicitReaction() { this->SetScheme(SCHEME_EXPLICIT_REACTION); }
  void SetSchemeToTangentPlane() { this->SetScheme(SCHEME_TANGENT_PLANE); }
  void SetSchemeToMinimizingMovement() { this->SetScheme(SCHEME_MINIMIZING_MOVEMENT); }
  ///@}

  /**
   * The reaction of Scheme ExplicitReaction. Off (default): u |grad u|^p as printed in the paper.
   * On: u g |grad u|^2, which balances the diffusion, so that |u| hardly drifts even without
   * ProjectToSphere.
   */
  SURFACEDIFFUSION_SWITCH(ConsistentReaction);

  /**
   * On (default): vectors are normalised to u/|u| after each step. Off: lengths drift, and with
   * ExplicitReaction and p = 2 they diverge.
   */
  SURFACEDIFFUSION_SWITCH(ProjectToSphere);

  /**
   * On: u and -u are the same, as for principal directions. In each triangle the signs of the
   * corners are chosen so that |grad u| is smallest. The sign of the result has no meaning.
   * Default: off.
   */
  SURFACEDIFFUSION_SWITCH(LineField);

  enum TangentToType
  {
    TANGENT_TO_NONE = 0,
    TANGENT_TO_SURFACE = 1
  };

  ///@{
  /**
   * What the vectors are tangent to. None (default): any unit vector. Surface: the part of three
   * components in the tangent plane of the surface (N. Max, J. Graphics Tools 4(2), 1999) is normalised,
   * and stays in that plane, for directions along the surface such as fibres. Vectors along the normal
   * are missing. |grad u| is that in space, so that a field that follows a bend of the surface has the
   * energy of the bend. MoveVertices must be off.
   */
  SURFACEDIFFUSION_CHOICE(TangentTo);
  void SetTangentToToNone() { this->SetTangentTo(TANGENT_TO_NONE); }
  void SetTangentToToSurface() { this->SetTangentTo(TANGENT_TO_SURFACE); }
  ///@}

  ///@{
  /**
   * On (default): if the input array is the surface's normals, the result becomes the output's
   * active normals, so that the shading shows it.
   */
  vtkSetMacro(UseAsNormals, bool);
  vtkGetMacro(UseAsNormals, bool);
  vtkBooleanMacro(UseAsNormals, bool);
  ///@}

  /**
   * On: the points of the output are moved so that its triangles turn as the normals have turned
   * (mesh denoising by vertex updating). They minimise 1/2 int |grad(N . x)|^2 + 1/(2 r^2) int
   * |x - x_0|^2 with N the turned normal of the triangle and r = 5 mean edge lengths. A map that
   * has changed nothing moves nothing. The input array must be the surface's normals. Points in single precision stay in single precision, all others
   * become double. Normals of the input on points or cells, that are active there or have the name
   * "Normals", are computed again for the moved points, and tangents are dropped; in surfaces in
   * pieces, only active normals are kept. GetMeanDisplacement() and the following values describe
   * the motion. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(MoveVertices);

  ///@{
  /**
   * The motion by MoveVertices in the last update, over all blocks: the area-weighted mean and the
   * largest displacement in coordinate units, and the enclosed volume before and after, signed by
   * the orientation. Blocks that are not closed or not consistently oriented have volume 0. All
   * values are 0 if MoveVertices was off.
   */
  SURFACEDIFFUSION_NUMBER(MeanDisplacement, double);
  SURFACEDIFFUSION_NUMBER(MaximumDisplacement, double);
  SURFACEDIFFUSION_NUMBER(VolumeBefore, double);
  SURFACEDIFFUSION_NUMBER(VolumeAfter, double);
  ///@}

  ///@{
  /**
   * The time integrator. FirstOrder (default) is the only one, see Scheme; others are an error.
   */
  SURFACEDIFFUSION_CHOICE(TimeIntegrator);
  void SetTimeIntegratorToFirstOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_FIRST_ORDER); }
  void SetTimeIntegratorToSecondOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_SECOND_ORDER); }
  ///@}

  /**
   * In addition to the superclass: Scheme ExplicitReaction, ConsistentReaction off, ProjectToSphere
   * on, LineField and MoveVertices off, TangentTo None. Exponent does not change.
   */
  void UsePaperScheme() override;

protected:
  vtkHarmonicMapFilter();
  ~vtkHarmonicMapFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;
  bool SolvesInPieces(
    const std::vector<SurfaceBlock>& pieces, bool oneSurface, double points) override;

  bool UseAsNormals = true;

private:
  vtkHarmonicMapFilter(const vtkHarmonicMapFilter&) = delete;
  void operator=(const vtkHarmonicMapFilter&) = delete;

  /// Whether no array is requested by name or as an attribute other than normals.
  bool UsesNormals();
  bool NeedsWholeSurface(const std::vector<SurfaceBlock>& pieces);
  vtkDataArray* FindComputedNormals(vtkPolyData* block);
  bool IsNormals(const SurfaceDiffusion::InputFields& fields, vtkPolyData* block) const;
};
VTK_ABI_NAMESPACE_END

#endif
