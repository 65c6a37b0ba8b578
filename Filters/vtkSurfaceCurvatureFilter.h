// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceCurvatureFilter
 * @brief   computes the curvature of a surface at a given scale
 *
 * Adds five point arrays: `MeanCurvature` H, which becomes the active scalars, `GaussianCurvature`
 * K, `PrincipalCurvatures` (k_1 >= k_2, with H = (k_1 + k_2)/2 and K = k_1 k_2), `ShapeIndex`
 * 2/pi atan((k_1 + k_2)/(k_1 - k_2)), and `Curvedness` sqrt((k_1^2 + k_2^2)/2). They are in 1/length
 * of the coordinates, K in its square, and the shape index has no unit.
 *
 * k_1 and k_2 are the eigenvalues of the derivative of the unit normals. They are positive where
 * the surface bends away from its normals: a sphere of radius R with the normals outward has
 * 1/R, and the shape index 1; with the normals inward -1/R, and -1. A saddle has the shape index 0,
 * and a plane, where it is not defined, 0, too. The normals are those of the triangles. Triangles
 * with another orientation than their neighbours count as turned, so that signs follow the larger
 * part of the area, and are counted in a warning. On surfaces with one side, such as a Moebius strip,
 * H has no sign, and is positive. Curvatures that the rounding of the coordinates may
 * cause, of single precision if all coordinates are such numbers, are 0.
 *
 * - FWHM 0: the scale of the mesh. A quadratic polynomial is fitted to the points of at most two
 *   edges from each point. Its error falls with the square of the length of the edges on even
 *   meshes, and with the length on others and at boundaries. Noise of the points is amplified by
 *   1/length^2. Convex corners of coarse solids are positive.
 * - FWHM > 0: the slope of the normals of these polynomials over the positions, by linear
 *   regression around each point. The weights are a Gaussian of this full width at half maximum
 *   on the surface, the kernel of the heat equation. Spheres keep their curvature at any scale, and
 *   other surfaces get its mean, with a bias in proportion to FWHM^2.
 *
 * At boundaries, both are one-sided: nothing is assumed about a continuation. Where three or more
 * triangles share an edge, the points of all of them count. Sharp edges have a curvature that grows
 * as the mesh becomes finer, unless FWHM limits it.
 *
 * Input array 1 (points or cells) is a mask: triangles with a nonzero point or cell take no part,
 * and the surface ends there. Points that no triangle uses get 0. The areas and angles of the
 * surface are those that are drawn.
 *
 * Surfaces in pieces, over processes and partitions, are gathered and solved in process 0; see
 * vtkSurfaceFilter.
 *
 * References: S. Petitjean, A Survey of Methods for Recovering Quadrics in Triangle Meshes, ACM
 * Comput. Surv. 34(2), 2002; J. Koenderink, A. van Doorn, Surface Shape and Curvature Scales, Image
 * Vis. Comput. 10(8), 1992 (shape index, curvedness).
 *
 * @sa vtkSurfaceDerivativesFilter vtkSurfaceDirectionFieldFilter
 */
#ifndef vtkSurfaceCurvatureFilter_h
#define vtkSurfaceCurvatureFilter_h

#include "vtkSurfaceRunAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceCurvatureFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceCurvatureFilter* New();
  vtkTypeMacro(vtkSurfaceCurvatureFilter, vtkSurfaceRunAlgorithm);

  /**
   * The scale: full width at half maximum of the Gaussian on the surface that weighs the normals,
   * in coordinate units. 0 or more. 0 (default): that of the mesh.
   */
  SURFACEDIFFUSION_PROPERTY(FWHM, double);

protected:
  vtkSurfaceCurvatureFilter();
  ~vtkSurfaceCurvatureFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceCurvatureFilter(const vtkSurfaceCurvatureFilter&) = delete;
  void operator=(const vtkSurfaceCurvatureFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
