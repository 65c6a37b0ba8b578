// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceInterpolationFilter
 * @brief   smooth function on a surface through values at a few points
 *
 * Finds the smoothest function u on a surface that has, or is near to, values d_i at points p_i,
 * such as activation times at electrodes or temperatures at buoys: the minimum of
 *
 *     E(u) = 1/2 sum_i w_i |u(p_i) - d_i|^2 + mu/2 int (kappa^2 u - div(D grad u))^2,
 *
 * a thin-plate spline on the surface (G. Wahba, Spline Models for Observational Data, SIAM 1990).
 * Diffusion to the steady state with held values (vtkFVMHeatFilter) is no method for values at
 * points: a point has no capacity in two dimensions, so that the result tends to a constant with a
 * spike at each value as the mesh becomes finer. For 162 exact values of a smooth field with the
 * standard deviation 9.06 on the sphere, the root mean square errors are
 *
 * | vertices | 642 | 2,562 | 10,242 | 40,962 | 163,842 |
 * | --- | --- | --- | --- | --- | --- |
 * | held values, steady state of the heat equation | 0.76 | 1.13 | 1.48 | 1.79 | 2.09 |
 * | this filter, Exact | 0.023 | 0.015 | 0.012 | 0.011 | 0.010 |
 *
 * **The values** are
 * - those of a surface with points on input port 1 (a vtkPointSet), which are projected to the
 *   nearest points of the surface, inside triangles, too. MaximumDistance leaves out far ones, and
 *   hidden points have no value; or
 * - without an input on port 1, those of the data (input array 0) that are neither NaN nor masked.
 *   A cell has its value in its middle.
 *
 * Several values at one place, up to about 1e-4 of an edge, count as their weighted mean; a warning
 * reports it if they differ. What differs at one place is noise, unless most places with repeats have
 * equal ones, which are copies then.
 * With composite data, each block takes all values.
 *
 * **Input arrays** in addition to those of the superclass (0, the data, 1, the mask, and 2,
 * directions e1 for AlongDiffusivity and AcrossDiffusivity):
 *
 * | idx | association | meaning |
 * | --- | --- | --- |
 * | 5 | points or cells | FidelityArray: the weights w of the data, 0 or more; 0: unknown |
 *
 * Values with standard deviations s_i have the weights 1/s_i^2, and NoiseLevel 1. Input array 3 is
 * not used.
 *
 * **Smoothing.** Exact holds the values. Otherwise mu, the strength of the smoothing, is found for
 * each component of the values on each connected part of the surface, by generalised
 * cross-validation (P. Craven, G. Wahba, Numer. Math. 31, 1979) or, with a NoiseLevel, by the
 * unbiased estimate of the risk (C. Mallows, Technometrics 15, 1973). Up to 300 values are
 * decomposed; with more, traces follow from determinants. Of few values cross-validation often
 * takes noise for signal: if up to 300 values would be all but held, mu is at least that with the
 * greatest restricted likelihood (G. Wahba, Ann. Statist. 13, 1985). Fewer than three places with
 * values are held, and fewer than five on open flat parts. Connected parts have nothing to do with each other: each has its own mu and s.
 *
 * **The mean.** With CorrelationLength 0, constants have no energy. With CorrelationLength 1/kappa,
 * values are measured from their weighted mean, to which u returns beyond that distance from the
 * values. That suits fields without long-range trends, and surfaces of which large parts have no
 * value.
 *
 * **Standard errors.** u is the mean of a Gaussian field with the precision
 * (mu Q + sum w_i b_i b_i^T)/s^2, where Q is the matrix of the energy (F. Lindgren, H. Rue,
 * J. Lindstrom, J. R. Statist. Soc. B 73, 2011), and `<name>Error` its standard error at each point:
 * a band of 1.645 of them on each side holds 90 %. It is infinite where the values leave the slope
 * open, as one or two and those on a line do on flat pieces with Free. s is NoiseLevel, or estimated
 * from the misfit and from repeats at one place; NaN if the values leave none. With an estimated s the
 * standard deviation is multiplied by Student's quantile over the normal one. With AutomaticSmoothing it
 * is the root of the mean square of the error over the posterior distribution of mu, whose prior is the
 * half-Cauchy distribution of mu^(-1/4), the wave number beyond which u is smoothed (A. Gelman, Bayesian
 * Anal. 1, 2006). Fields that
 * are smoother than splines are covered by more. Correlated noise is taken for signal; a warning reports
 * values without white noise. With CorrelationLength the error of the mean m is added,
 * (1 - a_i)^2 Var(m), where a is the fit of
 * values that are all 1. On cells it is the mean of the corners, an upper bound.
 *
 * **Boundary.** Natural: du/dn = 0 and d(Laplace u)/dn = 0, so that u becomes flat towards the
 * boundary. Free: the Hessian energy (O. Stein, A. Jacobson, M. Wardetzky, E. Grinspun, ACM Trans.
 * Graph. 39, 2020), which continues slopes and lets linear functions on flat pieces come back exactly.
 * Automatic: Free on connected parts with a boundary, Natural on closed ones and with diffusivities
 * other than 1 or IntrinsicDelaunay. The velocity of a planar wave of 0.6 m/s from 60 electrodes with
 * noise of 1 ms is 0.60 m/s near the boundary with Free, and 0.8 to 1.1 m/s with Natural.
 *
 * **Scheme.** Linear elements with lumped masses, Q = (kappa^2 M + K) M^-1 (kappa^2 M + K), whose
 * error falls with order 2. Cotangents of needles count up to 1e4, since Q squares them. The system
 * is factorised; the factor of Q has about three times the entries of that of K.
 *
 * **Output.** Port 0: the input with `<name>Interpolated` (active) and, with ComputeError,
 * `<name>Error`, where name is that of the array of values. ResultArrayName, if it is not empty, is
 * the name of the former and the prefix of the latter. Connected components without a value are
 * NaN, which a warning counts. Port 1: a table with a row per component of the values: `Block`,
 * `Component`, `Smoothing` (mu, in the unit of Smoothing; 0: the values hold; of several connected
 * parts that of the one with the most values), `Score` (of cross-validation), `Misfit` (the root of the
 * weighted mean square of u(p) - d), `DegreesOfFreedom` (their sum over the parts), and `NoiseLevel` (s,
 * given or estimated, the root of its mean square over the parts).
 *
 * A surface in pieces is gathered in process 0, with the points of all processes.
 *
 * @sa vtkFVMHeatFilter
 */
#ifndef vtkSurfaceInterpolationFilter_h
#define vtkSurfaceInterpolationFilter_h

#include "vtkSurfaceModelAlgorithm.h"

#include <memory> // for the values
#include <string> // for names
#include <vector> // for numbers that stand for no value

namespace SurfaceDiffusion
{
struct PointSamples;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceInterpolationFilter : public vtkSurfaceModelAlgorithm
{
public:
  static vtkSurfaceInterpolationFilter* New();
  vtkTypeMacro(vtkSurfaceInterpolationFilter, vtkSurfaceModelAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum BoundaryType
  {
    BOUNDARY_NATURAL,
    BOUNDARY_FREE,
    BOUNDARY_AUTOMATIC
  };

  ///@{
  /**
   * The names of point arrays of the points on input port 1: the values, with any number of
   * components, NaN: unknown (default: empty, their active scalars), and the weights w, one
   * component, 0 or more, 0: unknown (default: empty, 1 everywhere).
   */
  SURFACEDIFFUSION_NAME(PointValueArray);
  SURFACEDIFFUSION_NAME(PointWeightArray);
  ///@}

  /**
   * On: u has the values exactly. Off (default): u is smoothed, as noisy values need.
   */
  SURFACEDIFFUSION_SWITCH(Exact);

  /**
   * On (default): mu is found for each component, see above. Off: mu is Smoothing.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticSmoothing);

  /**
   * s, the standard deviation of values with weight 1, in the unit of the data, 0 or more.
   * AutomaticSmoothing and the standard errors use it. 0 (default): estimated.
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLevel, double);

  /**
   * mu, with AutomaticSmoothing off: above 0, in length^2 (natural units: h^2). Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(Smoothing, double);

  /**
   * 1/kappa, the distance beyond which u returns to the mean of the values of its connected
   * component, in coordinate units, 0 or more. 0 (default): infinite.
   */
  SURFACEDIFFUSION_PROPERTY(CorrelationLength, double);

  /**
   * On: each component of u stays between its smallest and its largest value, by an active set
   * (M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2002), and is smooth inside. Off
   * (default): u may leave the range between the values. It does not change standard errors.
   */
  SURFACEDIFFUSION_SWITCH(KeepRange);

  /**
   * On: the output has the standard error of u and, unless the values hold, `SlopeError`, that of its
   * derivative in a direction, in the unit of the data over that of the coordinates, without that of the
   * mean. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(ComputeError);

  /**
   * On: values that the others contradict are found and left out, those farther from a robust fit than
   * four standard deviations of the others; up to half of the values may be wrong. For data on the
   * surface, the output has the arrays `Outliers`, 1 or 0, and `Residuals`, at the points or cells with
   * values, with the name of the data before. Not with Exact. Default: off; a warning counts such
   * values then, with AutomaticSmoothing.
   */
  SURFACEDIFFUSION_SWITCH(Robust);

  /**
   * On: for data on the surface, the output has the arrays `LeaveOneOutResiduals`, how far each value
   * is from the result without it at the same mu, and `LeaveOneOutErrors`, the standard errors of
   * these, NaN for outliers, and `Residuals`, with the name of the data before. Not with Exact.
   * Default: off.
   */
  SURFACEDIFFUSION_SWITCH(LeaveOneOut);

  ///@{
  /**
   * The condition at the boundary of the surface, see above. Default: Automatic. Free takes neither
   * diffusivities other than 1 nor IntrinsicDelaunay.
   */
  SURFACEDIFFUSION_CHOICE(Boundary);
  void SetBoundaryToNatural() { this->SetBoundary(BOUNDARY_NATURAL); }
  void SetBoundaryToFree() { this->SetBoundary(BOUNDARY_FREE); }
  void SetBoundaryToAutomatic() { this->SetBoundary(BOUNDARY_AUTOMATIC); }
  ///@}

  /**
   * The largest distance of points on port 1 from the surface, in coordinate units, 0 or more.
   * Farther ones are counted and left out. 0 (default): any distance.
   */
  SURFACEDIFFUSION_PROPERTY(MaximumDistance, double);

  ///@{
  /**
   * Numbers that stand for no value, as NaN does, such as -10000 in electroanatomical maps: finite, compared
   * up to single precision. Values with one of them in any component do not count, in the data and at the
   * points on port 1. Default: none; a warning asks about known ones that lie far from all other values.
   * GetMissingValue() gives NaN for an index outside of the list.
   */
  void AddMissingValue(double value);
  void RemoveAllMissingValues();
  int GetNumberOfMissingValues();
  double GetMissingValue(int index);
  ///@}

  ///@{
  /**
   * Factors of D along and across the direction, above 0. Default: 1. If they differ, input array 2
   * is required.
   */
  SURFACEDIFFUSION_PROPERTY(AlongDiffusivity, double);
  SURFACEDIFFUSION_PROPERTY(AcrossDiffusivity, double);
  ///@}

  /**
   * On (default): the results of data on cells are on cells, the means of u. Off: on points.
   */
  SURFACEDIFFUSION_SWITCH(ResultOnCells);

  /**
   * mu of the first component in the last update, on the connected part with the most values, in the
   * unit of Smoothing; 0 if the values hold.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveSmoothing, double);

  ///@{
  /**
   * The number of values that the last update used, and of those that are farther than
   * MaximumDistance.
   */
  SURFACEDIFFUSION_NUMBER(NumberOfValues, int);
  SURFACEDIFFUSION_NUMBER(NumberOfFarValues, int);
  ///@}

  ///@{
  /**
   * The median and the largest distance of the points on port 1 from the surface in the last update,
   * in coordinate units. Without MaximumDistance, a warning reports points beyond five mean edge
   * lengths, but at least 2 % and at most 10 % of the size of the surface.
   */
  SURFACEDIFFUSION_NUMBER(MedianDistance, double);
  SURFACEDIFFUSION_NUMBER(LargestDistance, double);
  ///@}

protected:
  vtkSurfaceInterpolationFilter();
  ~vtkSurfaceInterpolationFilter() override = default;

  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSurfaceInterpolationFilter(const vtkSurfaceInterpolationFilter&) = delete;
  void operator=(const vtkSurfaceInterpolationFilter&) = delete;

  std::vector<double>& GetMissingValues();

  std::string PointValueArray;
  std::string PointWeightArray;
  bool HasPoints = false; ///< during an update
  std::shared_ptr<const SurfaceDiffusion::PointSamples> Samples; ///< likewise
  Problems ProblemsOfPoints; ///< likewise
};
VTK_ABI_NAMESPACE_END

#endif
