// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRandomFieldFilter
 * @brief   draws Gaussian random fields of a given width or range on a surface
 *
 * Adds the point array `RandomField`, the active scalars, with a component for each of
 * NumberOfFields independent Gaussian random fields of mean 0. With L = M^-1 K, the lumped mass
 * matrix M, the stiffness matrix K of the cotan weights, and white noise W, independent at the
 * points with variances 1 / A_i, they are, divided by their standard deviations,
 *
 * | Covariance | field | correlation on the plane at distance r |
 * | --- | --- | --- |
 * | Gaussian | exp(-t L) W, t = FWHM^2 / (16 ln 2) | exp(-2 ln 2 r^2 / FWHM^2) |
 * | MaternNu1 | (kappa^2 + L)^-1 W | (kappa r) K_1(kappa r), kappa = sqrt(8) / Range |
 * | MaternNu3 | (kappa^2 + L)^-2 W | (kappa r)^3 K_3(kappa r) / 8, kappa = sqrt(24) / Range |
 * | Matern | (kappa^2 + L)^(-(nu + 1) / 2) W | (kappa r)^nu K_nu(kappa r) / (2^(nu - 1) Gamma(nu)), kappa = sqrt(8 nu) / Range, nu = Smoothness |
 *
 * The boundary condition is the homogeneous Neumann condition. The fields serve as rough textures,
 * as noise with a width, and as maps without a relation to others.
 *
 * **Scheme.** exp(-t L) is a polynomial of degree 10 in one step of backward Euler, to 2e-5; Matern's
 * fields take one and two solves with nu = 1 and 3. With other nu they are sums of up to 14 solves with a
 * factor each, a rational function whose covariance is exact to 0.5 % of the variance. With Normalize, the standard deviation of the discrete field at
 * each point is found by selected inversion of up to 10 sparse factors, to 4e-4, and the variance is
 * 1 everywhere. Otherwise it is that on the plane, which the field exceeds near boundaries (by
 * sqrt(2) on a straight one) and where the surface is small beside the width.
 *
 * Random numbers are a hash of RandomSeed, the number of the field, and the point's global id or,
 * without global ids, its coordinates: the fields do not depend on the numbering of the points, the
 * number of threads, or pieces, but for the tolerance of the solves, 1e-10. Surfaces and blocks with
 * the same ids or coordinates have the same fields: they need different seeds.
 *
 * Input array 1 (points or cells) is a mask: triangles with a nonzero point or cell take no part,
 * and the surface ends there. Points that no triangle uses get NaN. A warning reports widths below
 * two mean edges h of a surface, which its mesh does not resolve.
 *
 * Surfaces in pieces, over processes and partitions, are gathered and solved in process 0; see
 * vtkSurfaceFilter.
 *
 * References: F. Lindgren, H. Rue, J. Lindstrom, An Explicit Link between Gaussian Fields and
 * Gaussian Markov Random Fields, J. R. Statist. Soc. B 73, 2011; D. Bolin, K. Kirchner, The Rational SPDE
 * Approach for Gaussian Random Fields with General Smoothness, J. Comput. Graph. Stat. 29, 2020; K. Takahashi, J. Fagan, M. Chin,
 * Formation of a Sparse Bus Impedance Matrix, PICA 1973.
 *
 * @sa vtkFVMHeatFilter vtkSurfaceInterpolationFilter
 */
#ifndef vtkSurfaceRandomFieldFilter_h
#define vtkSurfaceRandomFieldFilter_h

#include "vtkSurfaceRunAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceRandomFieldFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceRandomFieldFilter* New();
  vtkTypeMacro(vtkSurfaceRandomFieldFilter, vtkSurfaceRunAlgorithm);

  enum CovarianceType
  {
    COVARIANCE_GAUSSIAN,
    COVARIANCE_MATERN_NU_1,
    COVARIANCE_MATERN_NU_3,
    COVARIANCE_MATERN
  };

  ///@{
  /**
   * The covariance, see above. Default: Gaussian.
   */
  SURFACEDIFFUSION_CHOICE(Covariance);
  void SetCovarianceToGaussian() { this->SetCovariance(COVARIANCE_GAUSSIAN); }
  void SetCovarianceToMaternNu1() { this->SetCovariance(COVARIANCE_MATERN_NU_1); }
  void SetCovarianceToMaternNu3() { this->SetCovariance(COVARIANCE_MATERN_NU_3); }
  void SetCovarianceToMatern() { this->SetCovariance(COVARIANCE_MATERN); }
  ///@}

  /**
   * Of Gaussian: full width at half maximum of the kernel that white noise would be smoothed with,
   * in coordinate units, 0 or more. 0 (default): 10 h.
   */
  SURFACEDIFFUSION_PROPERTY(FWHM, double);

  /**
   * Of Matern's: the distance at which the correlation has fallen to 0.14, in coordinate units, 0 or
   * more. 0 (default): 20 h.
   */
  SURFACEDIFFUSION_PROPERTY(Range, double);

  /**
   * nu of the covariance Matern: fields have derivatives of orders below it. Above 0, up to 4.
   * Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(Smoothness, double);

  /**
   * The number of fields, the components of the result. 1 or more. Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(NumberOfFields, int);

  /**
   * The seed of the random numbers. Default: 0.
   */
  SURFACEDIFFUSION_PROPERTY(RandomSeed, int);

  /**
   * On (default): the variance is 1 at every point. Off: fields are divided by the standard
   * deviation on the plane, see above.
   */
  SURFACEDIFFUSION_SWITCH(Normalize);

protected:
  vtkSurfaceRandomFieldFilter();
  ~vtkSurfaceRandomFieldFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceRandomFieldFilter(const vtkSurfaceRandomFieldFilter&) = delete;
  void operator=(const vtkSurfaceRandomFieldFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
