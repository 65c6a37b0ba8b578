// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDirectionFieldFilter
 * @brief   computes line fields on a surface, as cell data
 *
 * Computes a line field (unit vectors up to their sign) from principal curvatures, as the smoothest
 * field in the sense of the vector Dirichlet energy, or from hints. The anisotropic diffusion
 * filters take such a field as their direction. The result is the cell array `Direction`, which is
 * made active. It is zero where there is no direction; the diffusion filters are isotropic there.
 *
 * - PrincipalCurvature: the minimum-curvature direction (Minimum) or the maximum-curvature
 *   direction (Maximum), from the derivative of the normals. The heat equation first smooths the
 *   normals over SmoothingLength. Cells where both are alike, up to what the rounding of the
 *   coordinates may cause, get zero vectors, with a warning that counts them.
 * - CurvatureAligned: the same where the principal curvatures differ distinctly, continued smoothly
 *   elsewhere.
 * - Smooth: the smoothest line field, which is the lowest mode of the connection Laplacian (F.
 *   Knoppel, K. Crane, U. Pinkall, P. Schroder, Globally Optimal Direction Fields, ACM Trans.
 *   Graph. 32(4), 2013). If there are several, it is the one closest to the principal direction.
 * - Hints: a smooth field that is close to the directions of input array 2 where these are given.
 *
 * A line at angle a is represented by the complex number z = exp(2 i a). CurvatureAligned and Hints
 * minimise
 *
 *     int |grad z|^2 + int w |z - z_hint|^2,    w = HintWeight / h^2,
 *
 * with the mean edge length h. For CurvatureAligned w is multiplied by the difference of the
 * absolute principal curvatures, divided by the mean of that difference. The discretisation uses
 * Crouzeix-Raviart elements (O. Stein, M. Wardetzky, A. Jacobson, E. Grinspun, A Simple
 * Discretization of the Vector Dirichlet Energy, CGF 39(5), 2020), and allows any angles and any
 * topology, orientable or not. By the Poincare-Hopf theorem, a line field on a closed surface of
 * nonzero Euler characteristic has singularities: on a sphere it typically has
 * four, of index 1/2.
 *
 * Input array 2 (points or cells, 3 components) has the hints. A vector that is zero or NaN is no
 * hint, and the length of a hint does not matter. Connected components without a hint get zero
 * vectors.
 *
 * Surfaces in pieces, over processes and partitions, are gathered and solved in process 0; see
 * vtkSurfaceFilter.
 *
 * Polygons and strips get the main axis of the directions of their triangles. Vertices and lines
 * get zero vectors.
 *
 * @sa vtkTuringTextureFilter vtkFVMHeatFilter vtkIntrinsicTVFilter
 */
#ifndef vtkSurfaceDirectionFieldFilter_h
#define vtkSurfaceDirectionFieldFilter_h

#include "vtkSurfaceRunAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDirectionFieldFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceDirectionFieldFilter* New();
  vtkTypeMacro(vtkSurfaceDirectionFieldFilter, vtkSurfaceRunAlgorithm);

  enum MethodType
  {
    METHOD_PRINCIPAL_CURVATURE = 0,
    METHOD_CURVATURE_ALIGNED = 1,
    METHOD_SMOOTH = 2,
    METHOD_HINTS = 3
  };

  ///@{
  /**
   * The method that computes the field, see above. Default: PrincipalCurvature.
   */
  SURFACEDIFFUSION_CHOICE(Method);
  void SetMethodToPrincipalCurvature() { this->SetMethod(METHOD_PRINCIPAL_CURVATURE); }
  void SetMethodToCurvatureAligned() { this->SetMethod(METHOD_CURVATURE_ALIGNED); }
  void SetMethodToSmooth() { this->SetMethod(METHOD_SMOOTH); }
  void SetMethodToHints() { this->SetMethod(METHOD_HINTS); }
  ///@}

  enum PrincipalDirectionType
  {
    PRINCIPAL_DIRECTION_MINIMUM = 0,
    PRINCIPAL_DIRECTION_MAXIMUM = 1
  };

  ///@{
  /**
   * The principal direction: the minimum-curvature direction (Minimum, the default; the axis of a
   * cylinder), or the maximum-curvature direction (Maximum), perpendicular to it. Curvatures are
   * compared by their absolute values.
   */
  SURFACEDIFFUSION_CHOICE(PrincipalDirection);
  void SetPrincipalDirectionToMinimum()
  {
    this->SetPrincipalDirection(PRINCIPAL_DIRECTION_MINIMUM);
  }
  void SetPrincipalDirectionToMaximum()
  {
    this->SetPrincipalDirection(PRINCIPAL_DIRECTION_MAXIMUM);
  }
  ///@}

  /**
   * The full width at half maximum of the Gaussian that smooths the normals before their derivative
   * is taken, in coordinate units. 0: no smoothing; -1 (default): four mean edge lengths.
   */
  SURFACEDIFFUSION_PROPERTY(SmoothingLength, double);

  /**
   * The weight of hints and curvatures against smoothness, in 1/h^2 with h the mean edge length.
   * The field follows changes of the hints over lengths down to about h/sqrt(HintWeight). Above 0.
   * Default: 0.1.
   */
  SURFACEDIFFUSION_PROPERTY(HintWeight, double);

  /**
   * The angle in degrees by which the field is rotated in the surface at the end, counter-clockwise
   * about the normals of the cells. Default: 0.
   */
  SURFACEDIFFUSION_PROPERTY(Angle, double);

protected:
  vtkSurfaceDirectionFieldFilter();
  ~vtkSurfaceDirectionFieldFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceDirectionFieldFilter(const vtkSurfaceDirectionFieldFilter&) = delete;
  void operator=(const vtkSurfaceDirectionFieldFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
