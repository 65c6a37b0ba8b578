// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTuringTextureFilter
 * @brief   reaction-diffusion textures on a surface: spots, stripes and labyrinths
 *
 * Solves the reaction-diffusion equations of two chemicals with concentrations u1 and u2 on a
 * triangulated surface,
 *
 *     du1/dt = div(g11 (grad u1 . e1) e1 + g12 (grad u1 . e2) e2) + F(u1, u2)
 *     du2/dt = div(g21 (grad u2 . e1) e1 + g22 (grad u2 . e2) e2) + G(u1, u2),
 *
 * by the finite volume method of C. Wu, J. Deng and F. Chen (IEEE TVCG 14(3), 2008, equations (22)
 * and (23)), with implicit diffusion and explicit reaction. The boundary condition is the
 * homogeneous Neumann condition. If u1 diffuses much faster than u2, the uniform state is unstable
 * and a pattern of one wavelength grows out of noise (A. Turing, 1952). Kinetics chooses F and G.
 * The default is (24), F = s (gamma - u1 u2), G = s (u1 u2 - u2 - mu).
 *
 * **The wavelength** follows from the rates: the fastest-growing wave number k maximises the larger
 * eigenvalue of J - k^2 diag(D1, D2), with the Jacobian J of (F, G) at the steady state and the
 * diffusion rates D1 and D2. FeatureSize sets the wavelength directly, in coordinate units, so that
 * it is the same on a coarse and on a fine mesh. Stationary patterns of (24) are some 5 % narrower
 * than the wave that they grew from. A warning explains why if no pattern can form with the given
 * parameters and rates: (24) with its default parameters needs D1/D2 > 4, and the mesh should have
 * 6 edges per wavelength.
 *
 * **Direction**: with a direction array (input array 2, for instance of
 * vtkSurfaceDirectionFieldFilter) the rates across the direction may differ from those along it. If
 * the rates of both chemicals are larger along e1 by one factor, the pattern is stretched along e1.
 * If only that of u2 is larger, stripes form along e1. Input array 4 gives the four rates per cell
 * (4 components: DiffusionRate1, DiffusionRateAcross1, DiffusionRate2, DiffusionRateAcross2), in
 * place of the properties and in their units, so that direction and width can vary over the
 * surface.
 *
 * **Start**: the initial state is the steady state with seeded noise, or the two components of
 * input array 0 if it is set (it is not by default). Missing values start from the mean of the
 * known values of the connected component.
 *
 * **Units**: natural units measure time in 1/ReactionRate, lengths in h (the mean edge length) and
 * diffusion rates in h^2 ReactionRate. Concentrations have the units of the kinetics.
 *
 * **Scheme**: diffusion is implicit with one matrix per chemical, and reaction is explicit.
 * TimeIntegrator SecondOrder (the default) is ARS(2,2,2) (Ascher, Ruuth, Spiteri 1997). FirstOrder
 * is the paper's: backward Euler with the reaction of the old level. ClampToNonNegative keeps
 * concentrations at 0 and above, because the values of (24) as printed diverge as soon as u2 < 0.
 * FirstOrder sets negative values to 0 after the step. SecondOrder solves the equations with the
 * constraint u >= 0 to second order (a reaction force holds u at 0 if the kinetics would make it
 * negative): on a sphere of 642 vertices after 5 units of time, the error at TimeStep 1/8 is 0.2 %,
 * that of FirstOrder 10 %. u1 and u2 are solved for on two threads if the machine has them. With
 * 44,000 vertices a step takes 10 ms of processor time, and the pattern is stationary after about
 * 18 units of time (StopTolerance 0.03).
 *
 * **Output**: the point arrays u1, u2 and Texture (the chosen chemical with its contrast stretched
 * to [0, 1]), and with ColorOutput the RGB array TextureColor. ResultArrayName, if it is not empty,
 * is put before each of these names. The active scalars are TextureColor if it is written, and
 * Texture otherwise. Points that no participating triangle uses keep the values of input array 0, or
 * get 0 if it is not set. The history has a further column `Clamped`: the number of concentrations that
 * were held at zero in the step. Its energy is 1/2 int (D1 grad u1 . grad u1 + D2 grad u2 . grad
 * u2) / ReactionRate, in coordinate units squared, which measures how much pattern there is. It
 * need not decrease.
 *
 * @sa vtkSurfaceDirectionFieldFilter vtkFVMHeatFilter
 */
#ifndef vtkTuringTextureFilter_h
#define vtkTuringTextureFilter_h

#include "vtkSurfaceDiffusionAlgorithm.h"

namespace SurfaceDiffusion
{
struct TextureSettings;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkTuringTextureFilter : public vtkSurfaceDiffusionAlgorithm
{
public:
  static vtkTuringTextureFilter* New();
  vtkTypeMacro(vtkTuringTextureFilter, vtkSurfaceDiffusionAlgorithm);

  enum KineticsType
  {
    KINETICS_TURING = 0,
    KINETICS_SCHNAKENBERG = 1,
    KINETICS_GRAY_SCOTT = 2,
    KINETICS_BRUSSELATOR = 3,
    KINETICS_GIERER_MEINHARDT = 4,
    KINETICS_FITZ_HUGH_NAGUMO = 5
  };

  ///@{
  /**
   * The reaction terms F and G, all multiplied by s = ReactionRate. u1 is the faster chemical in
   * each:
   *
   * | kinetics | F | G |
   * | --- | --- | --- |
   * | Turing (default) | gamma - u1 u2 | u1 u2 - u2 - mu |
   * | Schnakenberg | b - u1 u2^2 | a - u2 + u1 u2^2 |
   * | GrayScott | 25 (f (1 - u1) - u1 u2^2) | 25 (u1 u2^2 - (f + k) u2) |
   * | Brusselator | B u2 - u1 u2^2 | A - (B + 1) u2 + u1 u2^2 |
   * | GiererMeinhardt | nu (u2^2 - u1) | u2^2 / (u1 (1 + kappa u2^2)) - u2 |
   * | FitzHughNagumo | epsilon (u2 - beta u1 - alpha) | u2 - u2^3 - u1 |
   *
   * References: A. Turing 1952, G. Turk 1991; J. Schnakenberg 1979; P. Gray, S. Scott 1983, J.
   * Pearson 1993 (whose unit of time is 25 of ours); I. Prigogine, R. Lefever 1968; A. Gierer, H.
   * Meinhardt 1972; R. FitzHugh 1961, J. Nagumo et al. 1962. With the default rates, the default
   * parameters of all kinetics give a pattern, but only those of (24) and the Brusselator do so
   * within the default time.
   */
  SURFACEDIFFUSION_CHOICE(Kinetics);
  void SetKineticsToTuring() { this->SetKinetics(KINETICS_TURING); }
  void SetKineticsToSchnakenberg() { this->SetKinetics(KINETICS_SCHNAKENBERG); }
  void SetKineticsToGrayScott() { this->SetKinetics(KINETICS_GRAY_SCOTT); }
  void SetKineticsToBrusselator() { this->SetKinetics(KINETICS_BRUSSELATOR); }
  void SetKineticsToGiererMeinhardt() { this->SetKinetics(KINETICS_GIERER_MEINHARDT); }
  void SetKineticsToFitzHughNagumo() { this->SetKinetics(KINETICS_FITZ_HUGH_NAGUMO); }
  ///@}

  /**
   * The reaction rate s, in 1/time. Positive. The natural unit of time is 1/s. Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(ReactionRate, double);

  ///@{
  /**
   * The diffusion rates of u1 and u2 along e1, or in all directions without a direction array. 0 or
   * more. Default: 21 and 2.6, which in natural units give a wavelength of about 11 h with (24).
   */
  SURFACEDIFFUSION_PROPERTY(DiffusionRate1, double);
  SURFACEDIFFUSION_PROPERTY(DiffusionRate2, double);
  ///@}

  ///@{
  /**
   * The diffusion rates of u1 and u2 along e2, across the direction. 0 or more, or -1 (default):
   * the same as along e1. Rates that differ from those along e1 need the direction array.
   */
  SURFACEDIFFUSION_PROPERTY(DiffusionRateAcross1, double);
  SURFACEDIFFUSION_PROPERTY(DiffusionRateAcross2, double);
  ///@}

  /**
   * The requested wavelength, in coordinate units. 0 (default): with the default diffusion rates in
   * natural units, an eighth of the root of the area (of several parts, of their mean area by area)
   * where this root has fewer than 64 mean edge lengths h, in which lengths then mean nothing;
   * otherwise the rates as they are. All four diffusion rates are multiplied by one factor so that the
   * fastest-growing wavelength along e1 is FeatureSize (with rates per cell: the wavelength for their
   * means over the surface). If no wave grows fastest, the
   * rates do not change and a warning is given.
   *
   * A warning gives the RefineTo that resolves a wavelength below 6 mean edge lengths. Another one
   * says that no pattern has grown, and Texture is then uniform.
   *
   * RefineTo -1, the default of this class: edges are bisected to FeatureSize / 8 if FeatureSize is
   * above 0 and less than 6 mean edge lengths, which the mesh cannot resolve, and a warning says so. Otherwise,
   * and with 0, the surface stays as it is.
   */
  SURFACEDIFFUSION_PROPERTY(FeatureSize, double);

  /**
   * The half width of the uniform noise around the steady state, relative to it. It is absolute for
   * FitzHughNagumo, whose values have either sign. 0 or more. Default: 0.1.
   */
  SURFACEDIFFUSION_PROPERTY(InitialNoise, double);

  /**
   * On (default): concentrations are kept at 0 and above, see the class comment. The values of
   * FitzHughNagumo are not concentrations and are not constrained.
   */
  SURFACEDIFFUSION_SWITCH(ClampToNonNegative);

  /**
   * On: the time step is 1/8 of the time constant of the kinetics' fastest mode (1/16 for (24)),
   * regardless of TimeStep. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticTimeStep);

  /**
   * The run ends before NumberOfTimeSteps when the pattern is stationary, that is, when the
   * relative change per unit of time (root mean square, relative to that of the pattern) is at most
   * StopTolerance. A pattern that looks finished has about 0.05. Later times show the last state.
   * 0: all steps are computed. Default: 0.02, at which the correlation with the state after all
   * default steps is 0.98 (Turing kinetics, 2,562 vertices), after 284 of 640 steps.
   */
  SURFACEDIFFUSION_PROPERTY(StopTolerance, double);

  /**
   * On a surface with more vertices than this, the pattern grows on a coarser mesh first (nested
   * iteration). The steps run in a Galerkin space of smoothed aggregation with 6 vertices per
   * wavelength or more, or at least 3.4 if it has a ninth of the surface's vertices. They end when
   * the relative change per unit of time is 2.5 StopTolerance. The last two steps run on the
   * surface itself and remove the traces of interpolation. CoarseStartVertices is the size of the
   * coarser mesh. The history has all steps, and all states can be requested. With 655,362
   * vertices, a run takes 12 s of processor time instead of several minutes.
   *
   * Growing waves are within 5 % of their wavelength on the surface, but the pattern differs in
   * detail and is less settled: with the default rates, which give 3.4 vertices per wavelength, it
   * has more spots and fewer stripes. 0: all steps run on the surface. They also do over several
   * processes, from a given initial state (input array 0), with StopTolerance 0, and if the
   * wavelength is shorter than about 10 mean edge lengths. The coarser mesh has no Solver to choose
   * (conjugate gradients), and Tolerance is at least 1e-4 in all steps. 0 or more. Default: 50000,
   * the size up to which a run on the surface takes about 10 s on two cores.
   */
  SURFACEDIFFUSION_PROPERTY(CoarseStartSize, int);

  ///@{
  /**
   * The parameters of Turing: gamma and mu, above 0. A steady state needs gamma > mu. Default: 16,
   * 12.
   */
  SURFACEDIFFUSION_PROPERTY(GrowthRate, double);
  SURFACEDIFFUSION_PROPERTY(DecayRate, double);
  ///@}

  ///@{
  /**
   * The parameters of Schnakenberg: a and b, above 0. Default: 0.01, 1.
   */
  SURFACEDIFFUSION_PROPERTY(ActivatorSupply, double);
  SURFACEDIFFUSION_PROPERTY(SubstrateSupply, double);
  ///@}

  ///@{
  /**
   * The parameters of GrayScott: f and k, above 0. Default: 0.05, 0.06.
   */
  SURFACEDIFFUSION_PROPERTY(FeedRate, double);
  SURFACEDIFFUSION_PROPERTY(KillRate, double);
  ///@}

  ///@{
  /**
   * The parameters of Brusselator: A and B, above 0. Default: 2, 4.
   */
  SURFACEDIFFUSION_PROPERTY(ReactantA, double);
  SURFACEDIFFUSION_PROPERTY(ReactantB, double);
  ///@}

  ///@{
  /**
   * The parameters of GiererMeinhardt: nu, above 0, and kappa, 0 or more. Default: 1.05, 0.
   */
  SURFACEDIFFUSION_PROPERTY(InhibitorDecayRate, double);
  SURFACEDIFFUSION_PROPERTY(Saturation, double);
  ///@}

  ///@{
  /**
   * The parameters of FitzHughNagumo: epsilon and beta, above 0, and alpha. Default: 1.2, 0.9, 0.
   */
  SURFACEDIFFUSION_PROPERTY(RecoveryRate, double);
  SURFACEDIFFUSION_PROPERTY(RecoveryDamping, double);
  SURFACEDIFFUSION_PROPERTY(Stimulus, double);
  ///@}

  enum TextureChemicalType
  {
    TEXTURE_CHEMICAL_U1 = 0,
    TEXTURE_CHEMICAL_U2 = 1
  };

  ///@{
  /**
   * The chemical that Texture and TextureColor show. Default: U1.
   */
  SURFACEDIFFUSION_CHOICE(TextureChemical);
  void SetTextureChemicalToU1() { this->SetTextureChemical(TEXTURE_CHEMICAL_U1); }
  void SetTextureChemicalToU2() { this->SetTextureChemical(TEXTURE_CHEMICAL_U2); }
  ///@}

  ///@{
  /**
   * On: the output has the RGB point array TextureColor, a mixture of LowColor and HighColor
   * (components in [0, 1]) by Texture, as its active scalars. Default: off; the colours are dark
   * brown and sand.
   */
  SURFACEDIFFUSION_SWITCH(ColorOutput);
  virtual void SetLowColor(double red, double green, double blue);
  virtual void SetLowColor(const double color[3]);
  virtual double* GetLowColor() VTK_SIZEHINT(3);
  VTK_WRAPEXCLUDE virtual void GetLowColor(double& red, double& green, double& blue);
  VTK_WRAPEXCLUDE virtual void GetLowColor(double color[3]);
  virtual void SetHighColor(double red, double green, double blue);
  virtual void SetHighColor(const double color[3]);
  virtual double* GetHighColor() VTK_SIZEHINT(3);
  VTK_WRAPEXCLUDE virtual void GetHighColor(double& red, double& green, double& blue);
  VTK_WRAPEXCLUDE virtual void GetHighColor(double color[3]);
  ///@}

  ///@{
  /**
   * Values of the last update: the fastest-growing wavelength along e1 in coordinate units (0 if
   * there is none), its growth rate in 1/(unit of time), the factor by which FeatureSize multiplied
   * the diffusion rates, and the number of vertices of the coarser mesh on which the pattern grew
   * (0: it grew on the surface; see CoarseStartSize). For composite data they are those of the
   * first block.
   */
  SURFACEDIFFUSION_NUMBER(Wavelength, double);
  SURFACEDIFFUSION_NUMBER(WavelengthGrowthRate, double);
  SURFACEDIFFUSION_NUMBER(DiffusionRateFactor, double);
  SURFACEDIFFUSION_NUMBER(CoarseStartVertices, vtkIdType);
  ///@}

  ///@{
  /**
   * The time integrator, see the class comment. FirstOrder is the paper's. SecondOrder (default) is
   * more accurate. Implicit is an error.
   */
  SURFACEDIFFUSION_CHOICE(TimeIntegrator);
  void SetTimeIntegratorToFirstOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_FIRST_ORDER); }
  void SetTimeIntegratorToSecondOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_SECOND_ORDER); }
  ///@}

  /**
   * In addition to the superclass: Kinetics Turing.
   */
  void UsePaperScheme() override;

protected:
  vtkTuringTextureFilter();
  ~vtkTuringTextureFilter() override = default;

  bool MayRefineAutomatically() const override { return true; }
  double FindRefinement(
    double meanEdgeLength, SurfaceDiffusion::Sentence& explanation) const override;
  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkTuringTextureFilter(const vtkTuringTextureFilter&) = delete;
  void operator=(const vtkTuringTextureFilter&) = delete;

  SurfaceDiffusion::TextureSettings& GetTextureSettings() const;
};
VTK_ABI_NAMESPACE_END

#endif
