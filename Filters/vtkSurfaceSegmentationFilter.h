// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceSegmentationFilter
 * @brief   divides a surface into regions with short boundaries by its data
 *
 * Finds K regions of a surface by the convex Chan-Vese model (T. Chan, S. Esedoglu, M. Nikolova,
 * SIAM J. Appl. Math. 66, 2006) and, for K > 2, by the convex relaxation of Potts' model (on
 * surfaces C. Wu, J. Zhang, Y. Duan, X.-C. Tai, J. Sci. Comput. 50, 2012): the minimum over u, a
 * probability of each region at each point, of
 *
 *     E(u) = 1/2 sum_k int |grad u_k| + lambda sum_k int chi w u_k r_k, u_k >= 0, sum_k u_k = 1,
 *
 * the length of the boundaries plus lambda times the data terms r_k = |f - c_k|^2, where c_k is the
 * mean of region k. chi is the indicator of the known part, and w the fidelity of each point, 1 by
 * default. A point belongs to the region of its largest u_k. The means are given (SetMean) or found
 * (AutomaticMeans). Instead of f, the data terms r_k themselves can be given as an array with one
 * component per region, so that any feature can drive the segmentation: probabilities of a
 * classifier (r_k = -log p_k), distances from prototypes, and so on. Seeds are points whose label
 * is given. They suit interactive use: without any data term, the regions are those with the
 * shortest boundaries between the seeds.
 *
 * **Input arrays** in addition to those of the superclass (0, the data f, and 1, the mask):
 *
 * | idx | association | meaning |
 * | --- | --- | --- |
 * | 5 | points or cells | FidelityArray: w, one component, 0 or more. 0: missing |
 * | 6 | points or cells | seeds, one component: the labels 1 ... K, 0 = free |
 * | 7 | points or cells | the data terms r_k, K components, in place of f; NaN in one: missing |
 *
 * Input arrays 2 and 3 are not used. Missing points (mask, NaN) take the region that makes the
 * boundaries shortest. Points excluded by MaskMode Exclude, and connected components without a
 * known value or seed, have the label 0 and no boundaries.
 *
 * **The weight.** A disk of radius r is kept if lambda > 2/(r d^2) for data of two values with the
 * difference d. A cap of the angle theta on the unit sphere is kept if lambda d^2 > cot(theta/2).
 * By default (AutomaticFidelity) lambda is found from the data,
 *
 *     lambda = 0.6/(h D m), D = the mean of r_(2) - r_(1) over the known points where they differ,
 *
 * where r_(1) and r_(2) are the smallest two data terms of a point for the given means or, with
 * AutomaticMeans, for the clusters of the values. D is the contrast of the data, d^2 for two values
 * without noise. Noise hardly changes it, or raises it. So regions are kept from a radius of about
 * 3 h on, while noise of up to the distance of the means makes none. The mean has weights A w; m is
 * the mean of the factors w, so that these may have any unit. With AutomaticMeans, values beyond the
 * largest and the smallest 0.1 % count as these bounds if the whole range is more than three times
 * as wide, with a warning.
 *
 * **Units.** In natural units FidelityWeight is in 1/(h R^2), and in 1/(h R) with given data terms,
 * R their range. R includes the noise: under normal noise of half the difference of two values it
 * is about five times that difference, so that the same lambda has a number 25 times larger.
 *
 * **Scheme.** ADMM as in vtkIntrinsicTVFilter, with the projection onto the simplex, or the clamp
 * to [0, 1] for K = 2, until the duality gap certifies E up to StopTolerance. The means and u are
 * minimised over in turn until no mean changes by more than a thousandth of their range. E never
 * rises. For given means or data terms u is the global minimiser up to the tolerance. The
 * relaxation is exact for K = 2. With AutomaticMeans the result is a local minimum. The result is a
 * steady state: there are no time steps.
 *
 * **Output.** Port 0: the input with the point arrays `RegionId` (int, 1 to K, 0 at points of no
 * participating triangle; active), `RegionProbability` (u, K components) and, unless data terms are
 * given, `<name>Segmented` (c of the region). ResultArrayName, if it is not empty, is the name of
 * the last one and the prefix of the others. Port 1: a table
 * with a row per region: `Block`, `Region`, `Area`, `BoundaryLength`, `Components` (the number of
 * connected ones), and `Mean_0` ... of the data. Port 2: the boundaries as polylines that cut
 * triangles, level lines of u, with the cell arrays `Regions` (the two labels), `Length` and
 * `Block`. If the data are on cells, so are the arrays of port 0 (see ResultOnCells); points
 * between cells with different seeds are free. Areas and lengths are those of these lines. The
 * smaller lambda is, the better is their length: for data of two values with the difference d it is
 * right to 1 % at lambda h d^2 = 0.1, 3.5 % too long at 0.3, and 11 % at 0.7. AutomaticFidelity
 * makes it 6 to 11 % too long. The edges between points of different labels would be 10 to 12 % too
 * long at any lambda and mesh size.
 *
 * The energy of a surface in pieces is minimised in process 0, which has ports 1 and 2 alone.
 *
 * @sa vtkIntrinsicTVFilter
 */
#ifndef vtkSurfaceSegmentationFilter_h
#define vtkSurfaceSegmentationFilter_h

#include "vtkSurfaceModelAlgorithm.h"

#include <map> // for means
#include <utility> // for means

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceSegmentationFilter : public vtkSurfaceModelAlgorithm
{
public:
  static vtkSurfaceSegmentationFilter* New();
  vtkTypeMacro(vtkSurfaceSegmentationFilter, vtkSurfaceModelAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * K, the number of regions. 2 to 1000. Default: 2.
   */
  SURFACEDIFFUSION_PROPERTY(NumberOfRegions, int);

  /**
   * On (default): lambda is found from the contrast of the data, see above. FidelityWeight has no
   * effect.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticFidelity);

  /**
   * lambda, the weight of the data terms, with AutomaticFidelity off. The larger it is, the smaller
   * are the regions that are kept. 0 or more (0: seeds alone), in 1/(h R^2) in natural units, or
   * 1/(h R) with given data terms. Default: 0.3.
   */
  SURFACEDIFFUSION_PROPERTY(FidelityWeight, double);

  /**
   * On (default): the means c_k are found. The start are clusters of the values: of one component
   * those with the least sum of squares, otherwise those of k-means++ with RandomSeed. Then the
   * means of the regions and the regions are computed in turn. Under strong noise, of which they
   * would be clusters, they are clusters of averages over neighbours, and stay. Regions are numbered by ascending
   * mean (by its first component, then the next ones), unless there are seeds, whose labels they
   * then have. If there are fewer different values than regions, the others are not used, with a
   * warning, and their means are NaN. Off: the means are those of SetMean(), or the clusters of the
   * values if none is set. Not used with given data terms.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticMeans);

  /**
   * On (default): the results of data on cells are on cells: RegionProbability is the mean of u
   * over the cell, and RegionId its largest component, or the seed of the cell. Off: they are on
   * points.
   */
  SURFACEDIFFUSION_SWITCH(ResultOnCells);

  ///@{
  /**
   * The mean of a region, in array units: of region 1 ... NumberOfRegions, component 0, 1, ... of
   * the data. With AutomaticMeans off all of them have to be set, and no others, or none at all.
   * GetMean() gives NaN for one that is not set.
   */
  void SetMean(int region, int component, double value);
  double GetMean(int region, int component);
  void RemoveAllMeans();
  /// SetMean() for ParaView, whose rows of a list are three numbers of one type.
  void AddMean(double region, double component, double value);
  ///@}

  /**
   * The duality gap at which the minimisation stops, relative to E - lambda int chi min_k r_k, the
   * part of E that depends on u. In (0, 1). Default: 1e-3. A warning reports the gap if 10,000
   * iterations do not reach it.
   */
  SURFACEDIFFUSION_PROPERTY(StopTolerance, double);

  ///@{
  /**
   * Values of the last update: the certified relative duality gap of u; that of the labels as
   * functions on the mesh, whose boundaries are too long by a tenth; and the number of
   * minimisations. For composite data the largest of the blocks.
   */
  SURFACEDIFFUSION_NUMBER(Gap, double);
  SURFACEDIFFUSION_NUMBER(LabelGap, double);
  SURFACEDIFFUSION_NUMBER(NumberOfAlternations, int);
  ///@}

  /**
   * The lambda of the last update, in the unit of FidelityWeight: FidelityWeight, or the value that
   * AutomaticFidelity found. AutomaticFidelity finds one value for each block of composite data.
   * This is then the value of the first block, and each block has its own as field array
   * `EffectiveFidelityWeight`, with ResultArrayName as prefix.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveFidelityWeight, double);

  /**
   * The mean c of a region in the last update, in array units: the one that was given or found.
   * NaN if there is none. For composite data that of the first block.
   */
  double GetEffectiveMean(int region, int component);

protected:
  vtkSurfaceSegmentationFilter();
  ~vtkSurfaceSegmentationFilter() override = default;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

private:
  vtkSurfaceSegmentationFilter(const vtkSurfaceSegmentationFilter&) = delete;
  void operator=(const vtkSurfaceSegmentationFilter&) = delete;

  void PassMeans();
  void CheckPlacesOfMeans(int components, Problems& problems) const;

  std::map<std::pair<int, int>, double> Means; ///< by region and component
};
VTK_ABI_NAMESPACE_END

#endif
