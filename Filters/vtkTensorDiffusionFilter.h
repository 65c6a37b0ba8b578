// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTensorDiffusionFilter
 * @brief   diffusion of data along their own edges and lines on a triangulated surface
 *
 * Solves diffusion equations whose tensor D follows from the data f themselves,
 *
 *     m u_t = div(D grad u) + lambda chi (f - u),  u(0) = f,
 *
 * with no flux across the boundary, chi 1 where f is known and 0 where it is missing. All
 * components of the data, as the channels of a colour, share D, so that their edges stay in one
 * place. The result does not depend on how a colour is split into orthonormal components.
 *
 * - **Beltrami** (N. Sochen, R. Kimmel, R. Malladi, IEEE Trans. Image Process. 7(3), 1998): b u,
 *   drawn over the surface as a surface in more dimensions, shrinks its area
 *   int sqrt(det G), G = I + b^2 sum_k grad u_k grad u_k^T. D = sqrt(det G) G^-1 has the
 *   eigenvalues sqrt((1 + b^2 m2)/(1 + b^2 m1)) along the steepest direction and the inverse of
 *   that across it, where m1 >= m2 are the eigenvalues of the sum. m is sqrt(det G) with Metric
 *   Induced, the flow of the paper, and 1 with Metric Fixed. The steady states with values held
 *   fixed are minimal surfaces. The energy (area - area of the surface)/b^2 + lambda/2 int chi |u -
 *   f|^2 never rises, for any time step and on any mesh: sqrt(det(I + Q)) is concave in Q, so that
 *   the energy with D frozen lies above it.
 * - **CoherenceEnhancing** (J. Weickert, Int. J. Computer Vision 31, 1999): D is Alpha across lines
 *   and Alpha + (1 - Alpha) exp(-(K^2/(m1 - m2))^2) along them, with the eigenvalues m1 >= m2 of
 *   the structure tensor: that of Gaussian derivatives of scale NoiseScale, averaged by a Gaussian
 *   of scale IntegrationScale. The average is intrinsic (L. Naden, T. Maerz, C. Macdonald, arXiv
 *   1403.2131): tensors are transported between triangles by the parallel transport of the surface.
 *   Lines become more distinct, and interrupted ones are closed.
 * - **EdgeEnhancing** (J. Weickert, Anisotropic Diffusion in Image Processing, Teubner 1998): D is
 *   1 along edges and 1 - exp(-3.31488 (K^2/m1)^4) across them, with the structure tensor of
 *   scale NoiseScale and without average.
 *
 * AlongDiffusivity a1 and AcrossDiffusivity a2 weigh given directions e1 in addition: grad is then
 * S grad with S = sqrt(a1) e1 e1^T + sqrt(a2) e2 e2^T, and D is S D S.
 *
 * The unit of time in natural units is h^2 (h the mean edge length). Steps are semi-implicit: each
 * takes D and m at the old level and solves one linear system for the change of u, up to a residual
 * of Tolerance (default: 1e-6), a part of that at the start. A step of Beltrami costs about as much
 * as one of vtkIntrinsicTVFilter. One of CoherenceEnhancing costs about ten times as much, since
 * the structure tensor lives on edges.
 *
 * Without fidelity, fixed or held values, the sum of A_i u_i is conserved to a relative error of
 * 1e-12, except by Beltrami with Metric Induced.
 *
 * Missing data start from the harmonic function of the known values (InitialFill), since jumps at
 * the boundary of the hole would be kept as edges.
 *
 * **Output port 0**: the result, named as the data with the suffix `Beltrami`, `Coherent` or
 * `EdgeEnhanced`, and the cell array `DiffusionAxes` on request. ResultArrayName, if it is not
 * empty, is the name of the result and the prefix of `DiffusionAxes`. **Output port 1**: the
 * history. Its energy is that of Beltrami above, in (units of the array)^2. The other models have
 * no energy; the column has the variance 1/2 int |u - mean|^2, which without fidelity never rises
 * (a Lyapunov function, Weickert 1998).
 *
 * Surfaces in pieces are solved by all processes together, except by CoherenceEnhancing, whose
 * structure tensor needs the whole surface, and with DiffusionAxes: the pieces are then gathered
 * and solved in process 0.
 *
 * @sa vtkIntrinsicTVFilter vtkFVMHeatFilter vtkSurfaceDirectionFieldFilter
 */
#ifndef vtkTensorDiffusionFilter_h
#define vtkTensorDiffusionFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkTensorDiffusionFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkTensorDiffusionFilter* New();
  vtkTypeMacro(vtkTensorDiffusionFilter, vtkSurfaceDataDiffusionAlgorithm);

  enum ModelType
  {
    MODEL_BELTRAMI = 0,
    MODEL_COHERENCE_ENHANCING = 1,
    MODEL_EDGE_ENHANCING = 2
  };

  ///@{
  /**
   * The diffusion tensor. Default: Beltrami.
   */
  SURFACEDIFFUSION_CHOICE(Model);
  void SetModelToBeltrami() { this->SetModel(MODEL_BELTRAMI); }
  void SetModelToCoherenceEnhancing() { this->SetModel(MODEL_COHERENCE_ENHANCING); }
  void SetModelToEdgeEnhancing() { this->SetModel(MODEL_EDGE_ENHANCING); }
  ///@}

  /**
   * b of Beltrami: gradients above 1/b are edges. Natural units: in h/R. Positive; small values
   * give linear diffusion. Default: 10.
   */
  SURFACEDIFFUSION_PROPERTY(ColorScale, double);

  enum MetricType
  {
    METRIC_INDUCED = 0,
    METRIC_FIXED = 1
  };

  ///@{
  /**
   * The area that m of Beltrami measures. Induced (default): that of b u as a surface, m =
   * sqrt(det G), so that edges move slowly. Fixed: that of the surface itself, m = 1, so that the
   * sum of A_i u_i is conserved; with one component, steady states are those of the Charbonnier
   * function of vtkIntrinsicTVFilter with EdgeThreshold 1/b. The steady states of both are equal.
   */
  SURFACEDIFFUSION_CHOICE(Metric);
  void SetMetricToInduced() { this->SetMetric(METRIC_INDUCED); }
  void SetMetricToFixed() { this->SetMetric(METRIC_FIXED); }
  ///@}

  /**
   * sigma, the standard deviation of the Gaussian that smooths the data before their gradients are
   * taken for the structure tensor of CoherenceEnhancing and EdgeEnhancing. The data themselves
   * are not smoothed. Natural units: in h. 0: none. Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(NoiseScale, double);

  /**
   * rho, the standard deviation of the Gaussian that smooths the structure tensor of
   * CoherenceEnhancing: the distance over which the direction of lines is averaged. Natural units:
   * in h. 0: none; below NoiseScale it gives a warning. Default: 4.
   */
  SURFACEDIFFUSION_PROPERTY(IntegrationScale, double);

  /**
   * K, the gradient above which data are lines for CoherenceEnhancing and edges for EdgeEnhancing.
   * Natural units: in R/h. Positive. Default: 0.05, at which stripes with a period of 11 h in noise
   * of 30 % keep 99 % of their contrast for 10 h^2. R is the range with the noise, and lines are
   * weak in gaps: to close gaps of noisy lines take 0.01.
   */
  SURFACEDIFFUSION_PROPERTY(Contrast, double);

  /**
   * The diffusivity of CoherenceEnhancing across lines, and in all directions away from lines. From
   * 1e-12 to 1. Default: 1e-3.
   */
  SURFACEDIFFUSION_PROPERTY(Alpha, double);

  /**
   * On: the output has the cell array `DiffusionAxes`, the direction of the strongest diffusion at
   * the time of the output: unit vectors whose sign has no meaning, zero where diffusion is
   * isotropic. It is an error together with IntrinsicDelaunay. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(DiffusionAxes);

protected:
  vtkTensorDiffusionFilter();
  ~vtkTensorDiffusionFilter() override = default;

private:
  vtkTensorDiffusionFilter(const vtkTensorDiffusionFilter&) = delete;
  void operator=(const vtkTensorDiffusionFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
