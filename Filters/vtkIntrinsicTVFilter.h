// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIntrinsicTVFilter
 * @brief   edge-preserving denoising and inpainting of data on a surface
 *
 * Solves nonlinear diffusion on a triangulated surface, by default total variation flow,
 *
 *     u_t = div(g1 (grad u . e1) e1 + g2 (grad u . e2) e2) + lambda chi (f - u),   u(0) = f,
 *     g1 = AlongDiffusivity g(|grad u|),   g2 = AcrossDiffusivity g(|grad u|),
 *
 * by the finite volume method of C. Wu, J. Deng and F. Chen (IEEE TVCG 14(3), 2008) or by
 * minimising the energy of each step. chi is the indicator of the known part: 0 where data are
 * missing, 1 elsewhere. The boundary condition is the homogeneous Neumann condition. EdgeFunction
 * chooses the edge-stopping function g (the diffusivity), and AcrossEdgeFunction may choose another
 * one for g2. The special cases are the paper's (2) nonlinear diffusion, (3) intrinsic total
 * variation with g(s) = 1/sqrt(s^2 + beta), the default, (4) anisotropic diffusion with g1 and g2
 * functions of |grad u|, (17) denoising (lambda > 0) and (19) inpainting (missing data). The
 * gradient norm of colours combines their channels (ChannelCoupling), so that edges have the same
 * place in all of them. ColorModel describes colours by other unknowns than their components.
 *
 * **Units.** Let h be the mean edge length and R the range of the values. The natural unit of time
 * T is h R with EdgeFunction TotalVariation, whose speed depends on the height of the data: a step
 * of height R around a disk of radius r loses R in about r/2 units. With all other edge functions
 * T is h^2. FidelityWeight lambda is in 1/T (with FidelityNorm L1 in R/T), Beta in (R/h)^2 and
 * EdgeThreshold in R/h. In absolute units g is given by its formula in the units of coordinates and
 * values. If AcrossEdgeFunction has another dimension than EdgeFunction, natural units make its
 * formula one in x/h and u/R.
 *
 * **Schemes.** FirstOrder is the paper's (11): g is taken at the old level, and each step solves
 * one linear system (one per channel with PerChannel). It works for every edge function and keeps
 * the bounds of the data if no triangle is obtuse. It is the default: on noisy colours, ten steps
 * of the default size come within 0.3 dB of the minimiser in a third of the time of Implicit.
 * Implicit is backward Euler with g at the new level, for convex energies (TotalVariation,
 * Charbonnier, Constant, with AcrossEdgeFunction Same). Each step minimises int psi(|grad u|) +
 * lambda/2 int chi |u - f|^2 + 1/(2 dt) int |u - u_old|^2 by ADMM up to StopTolerance, without beta
 * for TotalVariation. Time steps may be long. SecondOrder is not available and is an error. Mode
 * SteadyState minimises the same energy without the last term, in one step. With diffusivities g1
 * along and g2 across a direction the integrand is
 *
 *     TotalVariation: sqrt((g1 grad u . e1)^2 + (g2 grad u . e2)^2),
 *     others:         g psi(sqrt((g1/g) (grad u . e1)^2 + (g2/g) (grad u . e2)^2)),
 *                     g the larger of g1 and g2,
 *
 * which has the flux of (4) for gradients along e1 or e2, and for all gradients if g1 = g2.
 *
 * Without fidelity, fixed or held values, the sum of A_i u_i is conserved to a relative error of
 * 1e-12. With FidelityNorm L2 it is conserved also with fidelity if nothing is missing.
 *
 * **Energy.** The energy in the history is int psi(|grad u|) + lambda/2 int chi |u - f|^2. With
 * FidelityNorm L1 the second term is lambda int chi |u - f|. psi is defined by psi'(s) = s g(s) and
 * psi(0) = 0. For TotalVariation it is sqrt(s^2 + beta) - sqrt(beta), or s with Implicit and
 * SteadyState. The energy is in (length unit)(array unit) for TotalVariation and in (array unit)^2
 * for the others. The column `Residual` is the duality gap with Implicit and SteadyState, relative
 * to the energy. The additional column `ErrorBound` is then sqrt(2 gap/(mu A)) in the array's unit,
 * gap the duality gap itself, mu = lambda chi (+ 1/dt with Implicit) and A the area where mu > 0:
 * since the energy is strongly convex, the root mean square over A of the difference from the exact
 * minimiser is not larger. It is that of the step alone; errors of several steps add up at most.
 * With CrouzeixRaviart it is that of the edge values. It is left out where mu = 0.
 *
 * @sa vtkFVMHeatFilter vtkHarmonicMapFilter vtkTuringTextureFilter
 */
#ifndef vtkIntrinsicTVFilter_h
#define vtkIntrinsicTVFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

// The edge functions in the order of their numbers: the word of their setters and that of their
// enumerators. Enumerators and setters of EdgeFunction and AcrossEdgeFunction are made from it.
// clang-format off
#define vtkIntrinsicTVFilterEdgeFunctions(entry)                                                   \
  entry(TotalVariation, TOTAL_VARIATION)                                                           \
  entry(PeronaMalikExponential, PERONA_MALIK_EXPONENTIAL)                                          \
  entry(PeronaMalikRational, PERONA_MALIK_RATIONAL)                                                \
  entry(Charbonnier, CHARBONNIER)                                                                  \
  entry(Weickert, WEICKERT)                                                                        \
  entry(Constant, CONSTANT)
// clang-format on

#define vtkIntrinsicTVFilterEdgeFunction(word, WORD) EDGE_FUNCTION_##WORD,
#define vtkIntrinsicTVFilterAcrossEdgeFunction(word, WORD) ACROSS_EDGE_FUNCTION_##WORD,
#define vtkIntrinsicTVFilterSetEdgeFunction(word, WORD)                                            \
  void SetEdgeFunctionTo##word()                                                                   \
  {                                                                                                \
    this->SetEdgeFunction(EDGE_FUNCTION_##WORD);                                                   \
  }
#define vtkIntrinsicTVFilterSetAcrossEdgeFunction(word, WORD)                                      \
  void SetAcrossEdgeFunctionTo##word()                                                             \
  {                                                                                                \
    this->SetAcrossEdgeFunction(ACROSS_EDGE_FUNCTION_##WORD);                                      \
  }

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkIntrinsicTVFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkIntrinsicTVFilter* New();
  vtkTypeMacro(vtkIntrinsicTVFilter, vtkSurfaceDataDiffusionAlgorithm);

  enum ModeType
  {
    MODE_TIME_STEPS = 0,
    MODE_STEADY_STATE = 1
  };

  ///@{
  /**
   * TimeSteps (default): NumberOfTimeSteps steps of TimeStep. SteadyState: the minimiser of the
   * energy, computed directly up to StopTolerance, without time steps and for TotalVariation
   * without beta. SteadyState needs EdgeFunction TotalVariation, Charbonnier
   * or Constant and AcrossEdgeFunction Same, and is an error otherwise. On a connected component
   * without fidelity and without fixed values the minimiser is the mean.
   */
  SURFACEDIFFUSION_CHOICE(Mode);
  void SetModeToTimeSteps() { this->SetMode(MODE_TIME_STEPS); }
  void SetModeToSteadyState() { this->SetMode(MODE_STEADY_STATE); }
  ///@}

  enum RegularizerType
  {
    REGULARIZER_TV = 0,
    REGULARIZER_TGV = 1
  };

  ///@{
  /**
   * What SteadyState minimises beside the fidelity. TV (default): int |grad u|, of which plateaus
   * with sharp edges have least. Ramps become stairs. TGV: total generalised variation of second
   * order (K. Bredies, K. Kunisch, T. Pock, SIAM J. Imaging Sci. 3(3), 2010), the minimum over w,
   * which has a tangent vector on each triangle, of
   *
   *     sum_T |T| |grad u - w_T| + alpha sum_e |e| |w_left - P w_right|,
   *
   * alpha = TGVLength. P turns the right triangle of the edge e into the plane of the left one, and
   * edges of three or more triangles do not count. Functions that are affine on a flat part of the
   * surface cost nothing there: ramps stay ramps, roofs keep their ridges, and ramps are continued
   * into missing regions. Edges between plateaus become less sharp. With the best weights,
   * for noise of 10 % on a sphere, a torus and a plate, the error of TV is 2.2 to 7.5 times that of
   * TGV on ramps and roofs, 1.1 to 1.5 times on ramps with a cliff and on waves, and 0.9 to 1 times
   * on plateaus. There are five times as many unknowns, and a gap of 1e-3, enough for noisy data,
   * takes 30 to 60 times as long.
   *
   * TGV needs Mode SteadyState, EdgeFunction TotalVariation, equal AlongDiffusivity and
   * AcrossDiffusivity (a factor of the sum above), Discretization Linear, BlurFWHM 0 and a
   * ColorModel other than ChromaticityBrightness, and is an error otherwise. It works in one
   * process. In the energy of the history it stands in place of int psi(|grad u|).
   */
  SURFACEDIFFUSION_CHOICE(Regularizer);
  void SetRegularizerToTV() { this->SetRegularizer(REGULARIZER_TV); }
  void SetRegularizerToTGV() { this->SetRegularizer(REGULARIZER_TGV); }
  ///@}

  /**
   * alpha of Regularizer TGV, a length in the unit of lengths that Units selects (natural units: h).
   * A bend of a line costs as much as a step of alpha times the change of its slope. A longer one
   * suppresses bends, and makes the result more like that of TV. Above 0. Default: 2. For noise of
   * 10 % the error with 1 is lower by a quarter on waves and by up to a fifth on roofs, that with 4
   * by up to 5 % on plateaus and ramps with a cliff.
   */
  SURFACEDIFFUSION_PROPERTY(TGVLength, double);

  enum EdgeFunctionType
  {
    vtkIntrinsicTVFilterEdgeFunctions(vtkIntrinsicTVFilterEdgeFunction)
  };

  ///@{
  /**
   * The edge-stopping function g(s), s = |grad u|, with K = EdgeThreshold:
   *
   * | edge function | g(s) | source |
   * | --- | --- | --- |
   * | TotalVariation (default) | 1/sqrt(s^2 + beta) | (3); Rudin, Osher, Fatemi 1992 |
   * | PeronaMalikExponential | exp(-(s/K)^2) | Perona, Malik 1990 |
   * | PeronaMalikRational | 1/(1 + (s/K)^2) | Perona, Malik 1990 |
   * | Charbonnier | 1/sqrt(1 + (s/K)^2) | Charbonnier et al. 1994 |
   * | Weickert | 1 - exp(-3.31488/(s/K)^8) | Weickert 1998, section 5.2 |
   * | Constant | 1 | (1), linear diffusion |
   *
   * (L. Rudin, S. Osher, E. Fatemi, Physica D 60, 1992; P. Perona, J. Malik, IEEE PAMI 12(7), 1990;
   * P. Charbonnier, L. Blanc-Feraud, G. Aubert, M. Barlaud, IEEE ICIP, 1994; J. Weickert,
   * Anisotropic Diffusion in Image Processing, Teubner, 1998.)
   *
   * Perona-Malik and Weickert sharpen edges that are steeper than about K, and equally steep noise.
   */
  SURFACEDIFFUSION_CHOICE(EdgeFunction);
  vtkIntrinsicTVFilterEdgeFunctions(vtkIntrinsicTVFilterSetEdgeFunction);
  ///@}

  enum AcrossEdgeFunctionType
  {
    ACROSS_EDGE_FUNCTION_SAME,
    vtkIntrinsicTVFilterEdgeFunctions(vtkIntrinsicTVFilterAcrossEdgeFunction)
  };

  ///@{
  /**
   * The edge-stopping function of g2, across the direction: Same (default) as EdgeFunction, or any
   * of the functions above, which makes (4) fully general. A function other than Same needs the
   * direction array, input array 2, and TimeIntegrator FirstOrder.
   */
  SURFACEDIFFUSION_CHOICE(AcrossEdgeFunction);
  void SetAcrossEdgeFunctionToSame() { this->SetAcrossEdgeFunction(ACROSS_EDGE_FUNCTION_SAME); }
  vtkIntrinsicTVFilterEdgeFunctions(vtkIntrinsicTVFilterSetAcrossEdgeFunction);
  ///@}

  /**
   * beta of TotalVariation, in (R/h)^2. Gradients well below its square root are smoothed as by
   * linear diffusion; larger gradients are preserved as edges. Above 0. Default: 1e-6. Implicit and
   * SteadyState do not use it.
   */
  SURFACEDIFFUSION_PROPERTY(Beta, double);

  /**
   * K of the other edge functions, in R/h. Gradients above it count as edges. Above 0. Default:
   * 0.1, a tenth of the range from one vertex to the next.
   */
  SURFACEDIFFUSION_PROPERTY(EdgeThreshold, double);

  enum ChannelCouplingType
  {
    CHANNEL_COUPLING_PER_CHANNEL = 0,
    CHANNEL_COUPLING_JOINT = 1
  };

  ///@{
  /**
   * The way in which the gradient norm combines the components. PerChannel: each component has its
   * own |grad u| (and |u - f| with FidelityNorm L1), so that the components do not depend on each
   * other. Joint (default): one Euclidean norm over all components, vectorial total variation (P.
   * Blomgren, T. Chan, IEEE Trans. Image Proc. 7(3), 1998), which avoids colour fringes.
   */
  SURFACEDIFFUSION_CHOICE(ChannelCoupling);
  void SetChannelCouplingToPerChannel() { this->SetChannelCoupling(CHANNEL_COUPLING_PER_CHANNEL); }
  void SetChannelCouplingToJoint() { this->SetChannelCoupling(CHANNEL_COUPLING_JOINT); }
  ///@}

  enum FidelityNormType
  {
    FIDELITY_NORM_L2 = 0,
    FIDELITY_NORM_L1 = 1
  };

  ///@{
  /**
   * The norm of the fidelity term. L2 (default): lambda (f - u), for Gaussian noise. L1: lambda (f
   * - u)/|f - u|, for impulse noise (salt and pepper). L1 replaces wrong values and preserves the
   * others, including their contrast (T. Chan, S. Esedoglu, SIAM J. Appl. Math. 65(5), 2005). With
   * FirstOrder the quotient is rounded over |f - u| < 1e-3 R, and |f - u| is taken at the old
   * level.
   */
  SURFACEDIFFUSION_CHOICE(FidelityNorm);
  void SetFidelityNormToL2() { this->SetFidelityNorm(FIDELITY_NORM_L2); }
  void SetFidelityNormToL1() { this->SetFidelityNorm(FIDELITY_NORM_L1); }
  ///@}

  /**
   * On (default): FidelityWeight 3, its default, stands for the lambda of the smallest estimated error of
   * the last state of the run; any other FidelityWeight is used as it is given. It is found by the
   * estimates of vtkFVMHeatFilter::AutomaticFidelity, with the mode, steps and discretisation of the
   * run. A warning reports it if no weight does, as in runs too short to remove the noise. For nine
   * kinds of noise, four signals and four surfaces the error was 1.03 times that of the best lambda
   * in the median, and at most 1.38 times in nine of ten cases. lambda is found for convex energies, as
   * SteadyState has them, with FidelityNorm L2; otherwise FidelityWeight is used as it is given.
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
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLevel, double);

  /**
   * The lambda of the last update, in the unit of FidelityWeight: FidelityWeight, or the value that
   * AutomaticFidelity found. AutomaticFidelity finds one for each component, unless ChannelCoupling is Joint, and each
   * connected component of the surface, since each may have noise of its own: this is that of the
   * first component and the largest connected component. In composite data it is the value of the
   * first block, and each block has its own as field array `EffectiveFidelityWeight`, with
   * ResultArrayName as prefix.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveFidelityWeight, double);

  enum DiscretizationType
  {
    DISCRETIZATION_LINEAR = 0,
    DISCRETIZATION_CROUZEIX_RAVIART = 1
  };

  ///@{
  /**
   * The finite elements. Linear (default): values at the vertices, as in the paper. The total
   * variation of an edge of the data that cuts across triangles is then some 10 % too large, so
   * that plateaus lose too much of their height. CrouzeixRaviart: values at the midpoints of the
   * mesh's edges (M. Crouzeix, P.-A. Raviart, RAIRO 7, 1973), which are three times as many;
   * plateaus are accurate to a fraction of a percent. Values are transferred from the vertices to
   * the midpoints and back conservatively. Fidelity then acts on mesh edges with two known ends,
   * and mesh edges with two fixed ends are fixed.
   */
  SURFACEDIFFUSION_CHOICE(Discretization);
  void SetDiscretizationToLinear() { this->SetDiscretization(DISCRETIZATION_LINEAR); }
  void SetDiscretizationToCrouzeixRaviart()
  {
    this->SetDiscretization(DISCRETIZATION_CROUZEIX_RAVIART);
  }
  ///@}

  /**
   * The duality gap, relative to the energy, at which SteadyState and each step of Implicit stop.
   * The gap bounds the difference between the energy and its minimum. In (0, 1). Default: 1e-4. A
   * warning reports the gap if 10,000 iterations do not reach it. MaximumNumberOfIterations and
   * Tolerance apply to the linear systems of FirstOrder. The default of Tolerance is 1e-3 in this
   * class, which changes ten steps by 2e-5 of the range and takes a quarter of the time of 1e-10.
   */
  SURFACEDIFFUSION_PROPERTY(StopTolerance, double);

  /**
   * The full width at half maximum of a blur that the data have gone through on the surface, in
   * coordinate units, regardless of Units, and that SteadyState removes; 0 (default): none. The
   * result is the minimiser of
   *
   *     int psi(|grad u|) + lambda/2 int chi |H u - f|^2,
   *
   * where H is the blur: BlurSteps steps of backward Euler for the heat equation, whose point
   * spread function on the plane has this width. The method is the monotone fast iterative
   * shrinkage-thresholding algorithm (MFISTA; A. Beck, M. Teboulle, IEEE Trans. Image Process. 18,
   * 2009). It stops when an iteration changes u by StopTolerance R, which is no bound of the error.
   * BlurFWHM needs Mode SteadyState, FidelityNorm L2 and Discretization Linear.
   * See AutomaticFidelity and AutomaticBlurFidelity. A warning reports a width outside 2 to 8 mean
   * edge lengths.
   * A camera blurs in its image, not on the surface: its point spread function differs from H where
   * the surface is oblique.
   */
  SURFACEDIFFUSION_PROPERTY(BlurFWHM, double);

  /**
   * The number of steps of the blur of BlurFWHM, 2 to 64. With 4, the default, its point spread
   * function has the half maximum of a Gaussian but longer tails: if the blur was that of heat
   * flow, waves of 1 to 2 widths come back up to half too high. More steps are more similar to a
   * Gaussian, and amplify noise more: 64 restore waves of 1.5 widths to 2 %.
   */
  SURFACEDIFFUSION_PROPERTY(BlurSteps, int);

  /**
   * Off: with BlurFWHM, FidelityWeight is used as it is given, also 3. Default: on. Without BlurFWHM it
   * has no effect.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticBlurFidelity);

  enum ColorModelType
  {
    COLOR_MODEL_RGB = 0,
    COLOR_MODEL_OPPONENT = 1,
    COLOR_MODEL_CHROMATICITY_BRIGHTNESS = 2
  };

  ///@{
  /**
   * The unknowns that colours, data of three components, are described by. Models other than RGB
   * need FidelityNorm L2, and no BlurFWHM; with other numbers of components they are an error.
   *
   * RGB (default): the components of the data.
   *
   * Opponent: the components along the orthonormal axes (1, 1, 1)/sqrt(3) of brightness and
   * (1, -1, 0)/sqrt(2), (1, 1, -2)/sqrt(6) of colour (J. van de Weijer, T. Gevers, A. Bagdanov,
   * IEEE PAMI 28(1), 2006). lambda is ChromaWeight times FidelityWeight on the axes of colour. With
   * ChromaWeight 1 and ChannelCoupling Joint the result is that of RGB.
   *
   * ChromaticityBrightness: u = B C with the brightness B = |u| and the chromaticity C, a unit
   * vector (T. Chan, S. Kang, J. Shen, J. Vis. Commun. Image Represent. 12, 2001; B. Tang, G.
   * Sapiro, V. Caselles, IEEE Trans. Image Process. 10, 2001), by the flow of
   *
   *     int psi(|grad B|) + mu/p int |grad C|^p + lambda/2 int chi |B C - f|^2,
   *
   * with p = ChromaticityExponent and mu = ChromaticityWeight. EdgeFunction acts on B. C is a
   * p-harmonic map into the unit sphere (vtkHarmonicMapFilter) with beta = Beta in 1/h^2. The
   * fidelity binds C by lambda B |f|, so that the hue of dark points, which is mostly noise, has
   * little weight; that of black points is missing, and continued from around them. A time step
   * moves B and then C, for fixed values of the other, in the metric |dB|^2 + R^2 |dC|^2; the
   * energy never grows. SteadyState alternates long steps until one decreases the energy by less
   * than StopTolerance of it; the column `Residual` is then this decrease. The energy is not
   * convex, and the result is a stationary point. Sums of A_i u_i are not conserved, and ErrorBound
   * is left out.
   */
  SURFACEDIFFUSION_CHOICE(ColorModel);
  void SetColorModelToRGB() { this->SetColorModel(COLOR_MODEL_RGB); }
  void SetColorModelToOpponent() { this->SetColorModel(COLOR_MODEL_OPPONENT); }
  void SetColorModelToChromaticityBrightness()
  {
    this->SetColorModel(COLOR_MODEL_CHROMATICITY_BRIGHTNESS);
  }
  ///@}

  /**
   * The factor of FidelityWeight on the two axes of colour of ColorModel Opponent. Below 1, colour
   * is smoothed more than brightness. Above 0. Default: 0.2, which was best on photographs with
   * white noise.
   */
  SURFACEDIFFUSION_PROPERTY(ChromaWeight, double);

  /**
   * p of ColorModel ChromaticityBrightness, from 1 to 2: 1 (default) keeps edges of hue, 2 smooths
   * evenly.
   */
  SURFACEDIFFUSION_PROPERTY(ChromaticityExponent, double);

  /**
   * mu of ColorModel ChromaticityBrightness, the weight of the smoothness of C beside that of B. In
   * R h^(p-1) with EdgeFunction TotalVariation, which is R for p = 1, and in R^2 h^(p-2) with
   * others. Above 0. Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(ChromaticityWeight, double);

  /**
   * On: unsigned char colours are decoded from sRGB (IEC 61966-2-1) to linear light, on the
   * same scale from 0 to 255, and the result is encoded, with ColorModel Opponent and
   * ChromaticityBrightness. Range, noise level, energy and totals are those of linear light.
   * Results below 0 and above 255 become 0 and 255, also if OutputPrecision is Single or Double.
   * Data of other types are taken as they are, and so are all data with ColorModel RGB.
   * Linear light is additive. But noise of equal strength in the bytes becomes strong in bright
   * colours: on a photograph with white noise of 10 to 40 % in its bytes, all models restored the
   * bytes by 1.8 to 4 CIEDE2000 better than linear light. Off (default) takes the bytes as they
   * are.
   */
  SURFACEDIFFUSION_SWITCH(LinearLight);

  ///@{
  /**
   * The time integrator, see the class comment. FirstOrder (default) is the paper's. SecondOrder is
   * an error.
   */
  SURFACEDIFFUSION_CHOICE(TimeIntegrator);
  void SetTimeIntegratorToFirstOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_FIRST_ORDER); }
  void SetTimeIntegratorToSecondOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_SECOND_ORDER); }
  void SetTimeIntegratorToImplicit() { this->SetTimeIntegrator(TIME_INTEGRATOR_IMPLICIT); }
  ///@}

  /**
   * In addition to the superclass: Mode TimeSteps, EdgeFunction TotalVariation, AcrossEdgeFunction
   * Same, ChannelCoupling PerChannel, FidelityNorm L2, AutomaticFidelity off, Discretization
   * Linear, ColorModel RGB.
   */
  void UsePaperScheme() override;

protected:
  vtkIntrinsicTVFilter();
  ~vtkIntrinsicTVFilter() override = default;

private:
  vtkIntrinsicTVFilter(const vtkIntrinsicTVFilter&) = delete;
  void operator=(const vtkIntrinsicTVFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
