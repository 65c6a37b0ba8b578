// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDenoisingFilter
 * @brief   removes the noise of the points of a surface and keeps its sharp edges
 *
 * The points move so that the triangles become orthogonal to regularised normals. Connectivity and
 * arrays stay. All weights follow from the noise level, which is estimated unless it is given, so
 * that no setting is necessary. Spikes, single points farther than 5 radii of the ring of their
 * neighbours from its middle, are moved there first; a warning counts them.
 *
 * The method alternates two steps. With the normals n0_f, the areas a_f and the centroids c_f of the
 * triangles of the present surface, the first finds regular normals n_f, the directions of
 *
 *     a_f n0_f + sum_g a_g w_fg n0_g,
 *     w_fg = exp(-|c_f - c_g|^2 / (2 s^2) - |m_f - m_g|^2 / (2 r^2)),
 *
 * over the triangles g that share a vertex with f. The guide normals m make the weights w_fg small
 * across sharp edges (W. Zhang, B. Deng, J. Zhang, S. Bouaziz, L. Liu, Guided Mesh Normal Filtering,
 * Computer Graphics Forum 34(7), 2015). Later iterations fit linear functions of the centroids with
 * the same weights, which keeps curvature. The second step moves the points x, which were given as
 * x0, towards the minimum of
 *
 *     sum_f 1/3 sum_{edges ij of f} (n_f . (x_i - x_j))^2
 *       + sum_i l_i (N_i . (x_i - x0_i))^2 + t |(I - N_i N_i^T) (x_i - x0_i)|^2
 *
 * with the vertex normals N, by one step of conjugate gradients: few steps regularise. l_i is
 * proportional to the inverse of the variance of the noise, and smaller for outliers. Tangential
 * displacements are small, so that triangles keep their shapes and boundary curves do not shrink.
 *
 * The displacements d along the normals decide, around each point, how many of the steps are kept.
 * With the sums s_i of d over point i and its neighbours, m_i points together, their whiteness R =
 * sum_i s_i^2 / m_i / sum_i d_i^2 is 1 for independent noise, smaller while noise is left, and
 * larger where details were removed. Where R is below 0.85 after all 33 to 60 steps, these have
 * removed noise only, and are kept. From 1.1 on, the result is that of careful steps, which become
 * smaller from R = 0.55 on, and 0 at 0.75; between 0.85 and 1.1 it is between the two. Careful
 * steps, and the share of the result of all steps, become smaller, too, from a mean of d^2 of 2
 * variances of the noise on, and 0 at 3. On CAD shapes, and for noise that is correlated over
 * several edges, the total generalised variation of the normals is minimised then (Z. Liu, Y. Li,
 * W. Wang, L. Liu, R. Chen, Mesh Total Generalized Variation for Denoising, TVCG 28(12), 2022), and
 * 15 steps towards the last normals follow.
 *
 * Connected components have noise levels, types and units of length of their own, so that several
 * surfaces in one data set are denoised as each alone. Noise that cannot be distinguished from the
 * shape stays unless NoiseLevel is given: that of components with less than 200 points, and of
 * those with more than a quarter of the edges within flat faces, which no noise leaves, or with
 * less than 30 % of the vertices on smooth faces, as on fans. Triangles may be oriented at random:
 * those across edges of two triangles are oriented alike inside. The result does not depend on the
 * numbering of points and cells.
 *
 * A surface whose estimated noise is 0 stays as it is, with a warning. Points that move by more
 * than 10 times the noise level are a warning, too, and so is a change of the volume of a closed
 * component by more than 2 %. Noise of more than half of the distance between
 * opposite sides of a thin part cannot be removed.
 *
 * Input array 3 (points, one component, optional): points with a nonzero value stay where they
 * are. They still guide their neighbours.
 *
 * Input array 6 (points or cells, one component, labels 0, 1, ..., optional): creases, which stay as
 * they are, and whose sides are smoothed apart. They are the edges between two points with nonzero
 * values, or between two cells of different labels, as those of the faces of a CAD model.
 *
 * The output has moved points and the point array `Displacement` (three components, in coordinate
 * units). The points keep their precision. Normals of the input, on points or cells, that are
 * active or have the name "Normals" are computed again for the moved points, and tangents are
 * dropped. In surfaces in pieces, only active normals are kept.
 *
 * Surfaces in pieces, over processes and partitions, are gathered and denoised in process 0; see
 * vtkSurfaceFilter. Each block of composite data is a surface of its own, with its own noise level.
 *
 * @sa vtkHarmonicMapFilter vtkWindowedSincPolyDataFilter
 */
#ifndef vtkSurfaceDenoisingFilter_h
#define vtkSurfaceDenoisingFilter_h

#include "vtkSurfaceRunAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDenoisingFilter : public vtkSurfaceRunAlgorithm
{
public:
  static vtkSurfaceDenoisingFilter* New();
  vtkTypeMacro(vtkSurfaceDenoisingFilter, vtkSurfaceRunAlgorithm);

  /**
   * How much noise is removed: the standard deviation of the displacement of the points along the
   * normal, in coordinate units. 0 or more. Default: 0, which means estimated for each connected
   * component. The estimate is the 0.3 quantile of the distances of points from quadrics through
   * their neighbours, over 0.3853, less the share of details, which have larger distances in larger
   * neighbourhoods. Estimates below 0.005 mean edge lengths are taken for none. Noise that
   * neighbouring points share is not always estimated, since it resembles details; if its level is
   * given, its length is found, too. See GetEffectiveNoiseLevel() and GetCorrelationLength().
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLevel, double);

  /**
   * Over how many edges points share their noise: the standard deviation, in mean edge lengths, of the
   * kernel that makes such noise of independent noise. 0 or more; below 0.5 the noise is independent.
   * Default: 0, which means measured, as far as correlated noise differs from relief: up to about
   * 3. With a length and without NoiseLevel, the level is measured for this length.
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLength, double);

  enum SurfaceTypeType
  {
    SURFACE_TYPE_AUTOMATIC = 0,
    SURFACE_TYPE_CAD = 1,
    SURFACE_TYPE_ORGANIC = 2
  };

  ///@{
  /**
   * The kind of surface. CAD: smooth faces, which may meet in sharp edges. Organic: shapes with
   * details of the size of a few triangles, such as scans. Automatic (the default): a component is
   * denoised as CAD, and this is kept if the displacements along the normals are then as white as
   * independent noise, R <= 1 within two standard deviations. Otherwise it is Organic: the variation
   * of normals would lose details. Noise that is found to be correlated has one method for both kinds,
   * and counts as CAD under Automatic. With Organic, a given NoiseLevel is that of independent noise.
   */
  SURFACEDIFFUSION_CHOICE(SurfaceType);
  void SetSurfaceTypeToAutomatic() { this->SetSurfaceType(SURFACE_TYPE_AUTOMATIC); }
  void SetSurfaceTypeToCAD() { this->SetSurfaceType(SURFACE_TYPE_CAD); }
  void SetSurfaceTypeToOrganic() { this->SetSurfaceType(SURFACE_TYPE_ORGANIC); }
  ///@}

  /**
   * Edges between triangles whose normals differ by this angle and more, in degrees, are creases,
   * 0 to 180: their points stay where they are, and the normals on the two sides do not smooth
   * each other. Default: 0, which means none; sharp edges are found then, and lose their noise, too.
   */
  SURFACEDIFFUSION_PROPERTY(CreaseAngle, double);

  /**
   * No point moves farther than this, in coordinate units. 0 or more. Default: 0, which means no limit.
   */
  SURFACEDIFFUSION_PROPERTY(DisplacementLimit, double);

  /**
   * The noise level of the last update, given or estimated, in coordinate units: the root mean
   * square over the points, and the largest of that over the blocks of composite data.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveNoiseLevel, double);

  /**
   * The length over which the noise of the last update was correlated, in coordinate units, as that of
   * depth cameras is: the largest over components and blocks. 0: no correlated noise was found.
   */
  SURFACEDIFFUSION_NUMBER(CorrelationLength, double);

  /**
   * The kind of surface of the last update, given or found: SURFACE_TYPE_CAD or
   * SURFACE_TYPE_ORGANIC. SURFACE_TYPE_AUTOMATIC before the first update, if no noise was found,
   * and if components or blocks of composite data are of different kinds; those without noise do
   * not count.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveSurfaceType, int);

  ///@{
  /**
   * The mean and the largest displacement of the last update, in coordinate units.
   */
  SURFACEDIFFUSION_NUMBER(MeanDisplacement, double);
  SURFACEDIFFUSION_NUMBER(MaximumDisplacement, double);
  ///@}

  ///@{
  /**
   * The enclosed volume before and after the last update, in coordinate units, signed by the
   * orientation. Blocks that are not closed or not consistently oriented have volume 0.
   */
  SURFACEDIFFUSION_NUMBER(VolumeBefore, double);
  SURFACEDIFFUSION_NUMBER(VolumeAfter, double);
  ///@}

protected:
  vtkSurfaceDenoisingFilter();
  ~vtkSurfaceDenoisingFilter() override;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceDenoisingFilter(const vtkSurfaceDenoisingFilter&) = delete;
  void operator=(const vtkSurfaceDenoisingFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
