// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDerivativesFilter
 * @brief   computes derivatives of data on a surface, and conduction velocities
 *
 * Input array 0 (points or cells) has the data u: scalars or vectors. The result is named after
 * them, followed by the Quantity, for instance `uGradient`, or has the name ResultArrayName. It is
 * made active.
 *
 * | Quantity | of | result |
 * | --- | --- | --- |
 * | Gradient | k components | 3k: the tangential gradients, in the unit of u per length |
 * | Divergence | vectors, 3k components | k: the divergence of their tangential parts |
 * | Curl | vectors, 3k components | k: the curl about the normals of the surface |
 * | Laplacian | k components | k: the divergence of the gradient, per length^2 |
 * | ConductionVelocity | times T, k components | 3k: grad T/\|grad T\|^2, and `Speed`, k: 1/\|grad T\|, `Collision` and `Focus`, k |
 * | Helmholtz | vectors, 3k components | k: `GradientPotential` phi and `CurlPotential` psi, and 3k: `GradientPart`, `CurlPart`, `HarmonicPart` |
 *
 * Times in ms on coordinates in mm give velocities in mm/ms = m/s. Where T does not change, the
 * velocity is not defined and is 0. Where fronts meet or begin (`Collision`, `Focus`: the direction turns
 * within an edge), `Speed` is NaN and the velocity 0. `Speed` has the name of the data before it, or
 * ResultArrayName.
 *
 * With the linear basis functions phi_i of the points, the areas a_t of the triangles and A_i of
 * the control cells, and the outward conormals nu of the boundary,
 *
 *     g_t = sum_i u_i grad phi_i                        (gradient on a triangle)
 *     g_i = P_i sum_t a_t g_t / sum_t a_t               (at a point, in its tangent plane)
 *     A_i d_i = - sum_t a_t v_t . grad phi_i + int over the boundary of phi_i v . nu
 *
 * is the discretisation; the curl is the divergence of v x n, and the Laplacian inside that of g_t.
 * For the divergence, vectors at points count by their parts across the normals of N. Max (J.
 * Graphics Tools 4(2), 1999), which are those of spheres where points lie on one. So the divergence
 * integrates to the flux across the boundary, and the curl to the circulation along it, up to
 * round-off. The Laplacian at a boundary point is that of the quadratic polynomial that fits the data
 * of the points at most two edges from it, or NaN, with a warning, if these are too few, as on a strip
 * of one row of cells. On planes all are exact for linear functions and fields, at the boundary, too,
 * and the Laplacian there for quadratic functions.
 *
 * Helmholtz splits vectors v_t on the triangles into grad(phi) + n x grad(psi) + h, orthogonal in the
 * sum of a_t v_t . w_t to 1e-12: phi and psi are linear on triangles, K phi and K psi the sums of
 * a_t v_t . grad(phi_i) and a_t v_t . (n x grad(phi_i)), psi is 0 on boundaries, and both have the mean
 * 0 on connected components otherwise, with a sign that follows the normals for psi. Parts at points
 * are the means of those of the triangles around. The five arrays have the name of the data before
 * theirs, or ResultArrayName; of the first, that alone. On surfaces with one side psi is 0.
 *
 * The gradient at points has an error of second order in the length of the edges inside of even
 * meshes, and of first order on others and at boundaries. The Laplacian inside is -K u/A with the
 * cotangent weights K. Its error is of second order where the points of a mesh look alike, and of
 * first order, as root mean square, on icospheres. On other meshes its means over several points
 * converge, but not its values at single points. Edges of three or more triangles are no boundary.
 * Triangles with another orientation than their neighbours count as turned, so that the signs of the
 * curl follow the larger part of the area. On surfaces with one side, such as a Moebius strip, the curl
 * has no sign, and its magnitude is given.
 *
 * SmoothingFWHM smooths the data first: the value at each point becomes that of the linear function
 * that fits the data around it, weighted with a Gaussian of this full width at half maximum on
 * the surface. Linear functions on planes stay as they are, at boundaries, too, where plain
 * smoothing would flatten them. White noise of standard deviation s at points of distance h leaves
 * an error of about s h/FWHM^2 in each component of the gradient.
 *
 * Scalars on cells, and vectors on cells if they are smoothed, go to the points first: each gets the
 * value of the linear function in its tangent plane that fits the data at the centroids of the
 * cells around it, at the boundary also of the next ones. So linear functions are exact for data on
 * cells, too. Vectors on cells are otherwise constant on each cell, so that the curl of a gradient
 * on cells is 0; along the boundary divergence and curl are then wrong for fields that vary.
 *
 * Input array 1 (points or cells) is a mask: triangles with a nonzero point or cell take no part,
 * and the surface ends there; so do triangles with missing data (NaN in any component). Points
 * without a triangle that takes part, and such cells, get 0, or NaN if any data are missing.
 * Infinite data are an error.
 *
 * Input array 10 (points), for ConductionVelocity, has the standard errors e of the slopes of the times, with
 * as many components: the `SlopeError` of vtkSurfaceInterpolationFilter. Then `SpeedLower` and `SpeedUpper`,
 * 1/(\|grad T\| +- 1.645 e), are the bounds of a band that holds 90 % of the speeds, named as `Speed` is.
 * They are NaN where the speed or e is, and the upper one is infinite where the times may be constant. Not
 * with SmoothingFWHM or ResultOnCells. Negative errors are an error.
 *
 * Surfaces in pieces, over processes and partitions, are gathered and solved in process 0; see
 * vtkSurfaceFilter.
 *
 * @sa vtkSurfaceCurvatureFilter vtkFVMHeatFilter
 */
#ifndef vtkSurfaceDerivativesFilter_h
#define vtkSurfaceDerivativesFilter_h

#include "vtkSurfaceRunAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDerivativesFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceDerivativesFilter* New();
  vtkTypeMacro(vtkSurfaceDerivativesFilter, vtkSurfaceRunAlgorithm);

  enum QuantityType
  {
    QUANTITY_GRADIENT = 0,
    QUANTITY_DIVERGENCE = 1,
    QUANTITY_CURL = 2,
    QUANTITY_LAPLACIAN = 3,
    QUANTITY_CONDUCTION_VELOCITY = 4,
    QUANTITY_HELMHOLTZ = 5
  };

  ///@{
  /**
   * What is computed, see above. Default: Gradient.
   */
  SURFACEDIFFUSION_CHOICE(Quantity);
  void SetQuantityToGradient() { this->SetQuantity(QUANTITY_GRADIENT); }
  void SetQuantityToDivergence() { this->SetQuantity(QUANTITY_DIVERGENCE); }
  void SetQuantityToCurl() { this->SetQuantity(QUANTITY_CURL); }
  void SetQuantityToLaplacian() { this->SetQuantity(QUANTITY_LAPLACIAN); }
  void SetQuantityToConductionVelocity() { this->SetQuantity(QUANTITY_CONDUCTION_VELOCITY); }
  void SetQuantityToHelmholtz() { this->SetQuantity(QUANTITY_HELMHOLTZ); }
  ///@}

  /**
   * The full width at half maximum of the Gaussian on the surface that smooths the data first, in
   * coordinate units. 0 or more. 0 (default): none.
   */
  SURFACEDIFFUSION_PROPERTY(SmoothingFWHM, double);

  /**
   * On: the result is on the cells. A gradient is then that of the linear function on each triangle
   * (the mean over the triangles of a polygon), and other quantities are means over the cell. Off
   * (default): the result is on the points.
   */
  SURFACEDIFFUSION_SWITCH(ResultOnCells);

protected:
  vtkSurfaceDerivativesFilter();
  ~vtkSurfaceDerivativesFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceDerivativesFilter(const vtkSurfaceDerivativesFilter&) = delete;
  void operator=(const vtkSurfaceDerivativesFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
