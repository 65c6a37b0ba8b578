// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDistanceFilter
 * @brief   computes distances along a surface, and the arrival times of fronts
 *
 * Adds the point array `Distance`, the length of the shortest way within the surface from the
 * nearest source, in coordinate units: the solution of |grad T| = 1 with T = 0 at the sources. With
 * speeds or start times it is the `ArrivalTime` T of fronts, |grad T| = 1/speed with T = T_0 at the
 * sources; where the speed has factors along and across a direction, grad T . D grad T = 1. It becomes the active scalars. Points that no way reaches have infinity, which
 * NumberOfUnreachedPoints counts: those on components without source, and those behind barriers.
 *
 * **Sources** are
 * - the places of the surface that are nearest to the points and lines on input port 1 (a
 *   vtkPointSet), inside triangles, too. Points that no line uses are sources of their own; lines,
 *   cells of the types VTK_LINE and VTK_POLY_LINE, are one source where they share points. Hidden
 *   points and lines, and lines with a hidden point, take no part; or
 * - without an input on port 1, the points at which input array 0 is not 0.
 *
 * **Paths.** From the places nearest to the points of a vtkPointSet on input port 2, output port 1 has
 * the shortest paths to their nearest source, as polylines: straight in each triangle and over edges,
 * as long as the distance of Method Exact, whichever the method is. Its cell arrays are `Length`, in
 * coordinate units, `PathPoint`, the number of the point on port 2, `NearestSource`, and `Block`. A
 * warning counts points that no path leads from. Not with speeds and start times. The time is that of
 * the exact distances of the whole surface.
 *
 * `NearestSource` is the value of array 0 at the nearest source, or on port 1 the number of
 * the point, of a line the smallest of its points. Points that no way reaches have 0, or -1.
 *
 * | input array | association | meaning |
 * | --- | --- | --- |
 * | 0 | points | SourceArray: nonzero points are sources; NaN is none. Default: the active scalars. Not used with port 1 |
 * | 1 | points or cells | MaskArray: triangles with a nonzero point or cell take no part, which is a barrier |
 * | 2 | points or cells | DirectionArray: directions e1, of any length and sign, for AlongSpeed and AcrossSpeed; zero or NaN is none, and the speed there has the geometric mean of both factors |
 * | 8 | points or cells | SpeedArray: the speed of fronts, 0 or more, in coordinate units per unit of time; on points, a triangle has the mean of its corners. Triangles of speed 0 are barriers |
 * | 9 | points | SourceTimes: T_0 of the sources of array 0 |
 * | 11, 12 | points or cells | AlongSpeedArray and AcrossSpeedArray: factors of the speed along and across array 2, which they need, 0 or more, beside AlongSpeed and AcrossSpeed. Triangles where both are 0, or one of them without a direction, are barriers; where one is 0, it counts as 1/1000 of the other, as does any that is less |
 *
 * Arrays 8, 9, 11 and 12, AlongSpeed and AcrossSpeed need Method Automatic or Eikonal. A source that the mask or a
 * barrier excludes, or that no triangle uses, does not count, with a warning; sources of port 1
 * near to excluded triangles do not move to others. Without any source that counts, the update is
 * an error. With MaximumDistance 0 a warning counts the points on port 1 that are farther from the
 * surface than five mean edges, but at least 2 % and at most 10 % of the diagonal of its bounding box.
 *
 * **Method.**
 * - Automatic: Exact where it takes at most a second, without speeds and start times, and Eikonal
 *   otherwise. GetEffectiveMethod() says which.
 * - Exact: the lengths of the shortest ways over the triangles, to round-off, by windows on their
 *   edges (J. S. B. Mitchell, D. M. Mount, C. H. Papadimitriou, SIAM J. Comput. 16(4), 1987).
 * - Heat: the heat method (K. Crane, C. Weischedel, M. Wardetzky, ACM Trans. Graph. 32(5), 2013)
 *   with the time step 1.1 h^2 of the mean edge length h, on the intrinsic Delaunay triangulation.
 *   Level sets are smooth, also where fronts meet. The mean error is 0.31 % of the largest distance
 *   on an icosphere of 10,242 points, and falls with order 0.5 to 0.9 in h; distances from lines
 *   are up to 2 h too long far away. Its two factors are kept: further sources on the same surface
 *   take two substitutions. At boundaries its condition is that of no flux.
 * - Eikonal: fast marching on the triangles (R. Kimmel, J. Sethian, PNAS 95, 1998) that lays the
 *   way from the source out in the plane of each triangle (M. Novotni, R. Klein, WSCG 2002), on the
 *   intrinsic Delaunay triangulation or, with speeds, on the triangles of the surface. Where
 *   triangles are few, their edges are bisected for it. Distances in planes are exact; mean errors
 *   on the same icosphere are 0.06 to 0.09 %.
 *
 * Where fronts of Eikonal arrive at the same time, as around a region on an even mesh, round-off
 * decides between them, so that another numbering of the points changes results by up to a quarter
 * of an edge, half of the error.
 *
 * The distance is the smallest of those of each source alone; with Heat only nearly so, and
 * NearestSource is that of Automatic. With speeds, points of input array 0 that are neighbours and
 * have one value are one source, whose front is plane between them.
 *
 * Ways end at boundaries, and go around their corners. Where three or more triangles share an edge,
 * ways go on from each of them to all others. With ComputeGradient, `DistanceGradient` or
 * `ArrivalTimeGradient` is the gradient in the tangent planes, the mean over the triangles around
 * each point by area: away from sources it has the length 1 or 1/speed. At sources and where fronts
 * meet the gradient is not continuous, and its mean is shorter.
 *
 * ResultArrayName, if it is not empty, is the prefix of the names of these arrays. With composite
 * data each block is a surface of its own, which takes the sources of its own array, or all those
 * of port 1, and all points of port 2. Surfaces in pieces, over processes and partitions, are gathered
 * and solved in process 0, which has the paths, with the points of ports 1 and 2 of all processes; see
 * vtkSurfaceFilter.
 *
 * @sa vtkSurfaceInterpolationFilter vtkSurfaceDerivativesFilter vtkDijkstraGraphGeodesicPath
 */
#ifndef vtkSurfaceDistanceFilter_h
#define vtkSurfaceDistanceFilter_h

#include "vtkSmartPointer.h" // for paths
#include "vtkSurfaceRunAlgorithm.h"

namespace SurfaceDiffusion
{
struct SourceShapes;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDistanceFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceDistanceFilter* New();
  vtkTypeMacro(vtkSurfaceDistanceFilter, vtkSurfaceRunAlgorithm);

  enum MethodType
  {
    METHOD_HEAT = 0,
    METHOD_EIKONAL = 1,
    METHOD_EXACT = 2,
    METHOD_AUTOMATIC = 3
  };

  ///@{
  /**
   * How distances are found, see above. Default: Automatic.
   */
  SURFACEDIFFUSION_CHOICE(Method);
  void SetMethodToHeat() { this->SetMethod(METHOD_HEAT); }
  void SetMethodToEikonal() { this->SetMethod(METHOD_EIKONAL); }
  void SetMethodToExact() { this->SetMethod(METHOD_EXACT); }
  void SetMethodToAutomatic() { this->SetMethod(METHOD_AUTOMATIC); }
  ///@}

  /**
   * The largest distance of points and lines on port 1 from the surface, in coordinate units, 0 or
   * more. Farther ones do not count. 0 (default): any distance.
   */
  SURFACEDIFFUSION_PROPERTY(MaximumDistance, double);

  ///@{
  /**
   * Factors of the speed along and across the direction, above 0. Default: 1. If they differ, input
   * array 2 is required. With directions e1, and e2 across them in the tangent plane, fronts have
   * D = speed^2 (AlongSpeed^2 e1 e1^T + AcrossSpeed^2 e2 e2^T): from one point in a plane they are
   * ellipses. Arrays 11 and 12 multiply them.
   */
  SURFACEDIFFUSION_PROPERTY(AlongSpeed, double);
  SURFACEDIFFUSION_PROPERTY(AcrossSpeed, double);
  ///@}

  /**
   * On: the output has the gradient of the result. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(ComputeGradient);

  /**
   * On: the distance is below 0 on one side. The sources of array 0 are a region, and the distance is
   * that to its boundary, a smooth line between its points and those around it, below 0 within. The
   * lines on port 1 are closed ones, and it is that to the shortest paths from one of their points to
   * the next, below 0 on the side of the smaller area; lines that do not divide the surface into two
   * sides are an error. Not with speeds and start times. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(Signed);

  ///@{
  /**
   * Of the last update: the number of sources that counted (points with a nonzero value; on port 1,
   * points and straight parts of lines), and that of points of the surface, merged ones counted
   * once, with an infinite result.
   */
  SURFACEDIFFUSION_NUMBER(NumberOfSources, int);
  SURFACEDIFFUSION_NUMBER(NumberOfUnreachedPoints, int);
  ///@}

  /**
   * The method of the last update, a MethodType. Of composite data with several, the lowest.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveMethod, int);

protected:
  vtkSurfaceDistanceFilter();
  ~vtkSurfaceDistanceFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;
  void PrepareOutputs(
    const std::vector<SurfaceBlock>& surfaces, const SurfaceDiffusion::SurfaceRuns& runs) override;
  std::vector<int> ArraysOfMarks() const override { return { 0, 3, 6 }; }
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSurfaceDistanceFilter(const vtkSurfaceDistanceFilter&) = delete;
  void operator=(const vtkSurfaceDistanceFilter&) = delete;

  // Of one update:
  bool HasSources = false; ///< there is a second input
  std::shared_ptr<const SurfaceDiffusion::SourceShapes> Sources, PathPoints;
  vtkSmartPointer<vtkPolyData> Paths;
  Problems ProblemsOfSources;
};
VTK_ABI_NAMESPACE_END

#endif
