// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceReliefFilter
 * @brief   raises or carves a point array as relief, for printing
 *
 * Each point moves by h d with its height
 *
 *     h = Base + Height v,
 *
 * where v is its value, usually from 0 to 1 as `Texture` of vtkTuringTextureFilter. With Levels Two
 * h is Base where v is below Threshold and Base + Height above it, with a slope of the width Flank
 * between them. d is the vector with d . n = 1 for the normals n of the triangles around the point,
 * in the sense of least squares weighted by angles, and has at most length 2. So flat faces at a
 * sharp edge move by h, and a relief of constant height on a box is a larger box. Positive heights
 * point out of closed surfaces, with any orientation of their cells.
 *
 * Heights are lowered where the surface would come too close to itself: h |d| is at most half of
 * the radius of the largest ball that touches the surface at the point, on the side to which it
 * moves, and has no other part of the surface inside. In the middle of a wall, this is a quarter of
 * its thickness, so that relief of up to 10 % of the thickness is not changed there. Near inner
 * edges relief fades over twice its height. Where triangles that did not cross others before still
 * do, heights are halved, and at last 0. A warning says so if more than 5 % of the points with
 * relief lose more than half of the largest height.
 *
 * Points on edges of one triangle, and of three or more, stay, so that rims fit what they fitted
 * before. The output has the same points and cells: it is closed where the input is. Relief needs
 * points: RefineTo bisects the long edges of CAD files.
 *
 * **Input arrays**, `SetInputArrayToProcess(idx, 0, 0, association, name)`:
 *
 * | idx | association | meaning |
 * | --- | --- | --- |
 * | 0 | points | the values v, one finite component. Default: `Texture`, of vtkTuringTextureFilter |
 * | 1 | points or cells | nonzero: no relief, such as faces that fit other parts; optional |
 *
 * The output has moved points, in the precision of the input's, and the point array `ReliefHeight`,
 * the heights that were used, in coordinate units; points of no triangle that takes part stay, and
 * have 0. Polygons are reversed where they face inwards or against their neighbours, so that files
 * for printing are oriented; triangle strips, and cells of surfaces in pieces, are not. Normals of
 * the input, on points or cells, that are active or have the name "Normals" are computed again for
 * the moved points, and tangents are dropped.
 *
 * Errors at update are properties that are not allowed, values that are not finite where they
 * count, and relief that is larger than the surface. Surfaces in pieces, over processes and
 * partitions, are gathered and processed in process 0; see vtkSurfaceFilter. Each block of
 * composite data is a surface of its own. Results do not depend on the number of threads.
 *
 * @sa vtkTuringTextureFilter vtkQuadricDecimation
 */
#ifndef vtkSurfaceReliefFilter_h
#define vtkSurfaceReliefFilter_h

#include "vtkSurfaceRunAlgorithm.h"

namespace SurfaceDiffusion
{
struct ReliefSettings;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceReliefFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceReliefFilter* New();
  vtkTypeMacro(vtkSurfaceReliefFilter, vtkSurfaceRunAlgorithm);

  ///@{
  /**
   * The height of the value 1 above that of the value 0, and the height of the value 0, in
   * coordinate units. Any finite numbers; below 0 relief is carved. Defaults: 1 and 0.
   */
  SURFACEDIFFUSION_PROPERTY(Height, double);
  SURFACEDIFFUSION_PROPERTY(Base, double);
  ///@}

  enum LevelsType
  {
    LEVELS_SMOOTH = 0,
    LEVELS_TWO = 1
  };

  ///@{
  /**
   * Smooth (default): heights are linear in the values. Two: the height is Base below Threshold and
   * Base + Height above.
   */
  SURFACEDIFFUSION_CHOICE(Levels);
  void SetLevelsToSmooth() { this->SetLevels(LEVELS_SMOOTH); }
  void SetLevelsToTwo() { this->SetLevels(LEVELS_TWO); }
  ///@}

  /**
   * The value in the middle between two levels. Any finite number. Default: 0.5.
   */
  SURFACEDIFFUSION_PROPERTY(Threshold, double);

  /**
   * The width of the slope between two levels, in coordinate units along the surface. The distance
   * from the line of the threshold is that of the linear function with the value and the gradient
   * at the point. 0 or more. Default: 0, a step.
   */
  SURFACEDIFFUSION_PROPERTY(Flank, double);

  /**
   * Faces that face down more steeply have no relief: the angle in degrees between their normal and
   * the horizontal, from 0 (no face that faces down) to 90, or -1 (default): all faces have relief.
   */
  SURFACEDIFFUSION_PROPERTY(Overhang, double);

  ///@{
  /**
   * The direction of printing, for Overhang. Not 0. Default: (0, 0, 1).
   */
  void SetUpDirection(double x, double y, double z);
  void SetUpDirection(const double direction[3]);
  double* GetUpDirection() VTK_SIZEHINT(3);
  ///@}

  /**
   * The enclosed volume after the last update less that before, in coordinate units. Surfaces that
   * are not closed count 0.
   */
  SURFACEDIFFUSION_NUMBER(VolumeChange, double);

  /**
   * The smallest distance between two opposite sides after the relief, from a point against its
   * normal to a triangle that faces away within 30 degrees, in coordinate units. Infinite if there
   * is none. 0 before the first update.
   */
  SURFACEDIFFUSION_NUMBER(SmallestWall, double);

  ///@{
  /**
   * Counts of the last update: points whose relief is lower than wanted, edges of one triangle (0:
   * the surface is closed) and of three or more, and triangles that cross others before and after
   * the relief.
   */
  SURFACEDIFFUSION_NUMBER(LoweredPoints, vtkIdType);
  SURFACEDIFFUSION_NUMBER(OpenEdges, vtkIdType);
  SURFACEDIFFUSION_NUMBER(NonManifoldEdges, vtkIdType);
  SURFACEDIFFUSION_NUMBER(CrossingTrianglesBefore, vtkIdType);
  SURFACEDIFFUSION_NUMBER(CrossingTriangles, vtkIdType);
  ///@}

protected:
  vtkSurfaceReliefFilter();
  ~vtkSurfaceReliefFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;
  void PrepareOutputs(
    const std::vector<SurfaceBlock>& surfaces, const SurfaceDiffusion::SurfaceRuns& runs) override;

private:
  vtkSurfaceReliefFilter(const vtkSurfaceReliefFilter&) = delete;
  void operator=(const vtkSurfaceReliefFilter&) = delete;

  SurfaceDiffusion::ReliefSettings& GetReliefSettings() const;
};
VTK_ABI_NAMESPACE_END

#endif
