// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMumfordShahFilter
 * @brief   edges and piecewise smooth approximation of data on a triangulated surface
 *
 * Minimises the functional of Mumford and Shah (CPAM 42, 1989) in the approximation of L. Ambrosio
 * and V. Tortorelli (CPAM 43, 1990); on meshes N. Bonneel, D. Coeurjolly, P. Gueth and J.-O.
 * Lachaud (Computer Graphics Forum 37(7), 2018):
 *
 *     E(u, v) = lambda/2 int chi |u - f|^2 + 1/2 int (v^2 + kappa) D grad u . grad u
 *               + beta int (eps |grad v|^2 + (1 - v)^2 / (4 eps)),
 *
 * over u, which is smooth between its edges, and v in (0, 1], which is near 0 on edges and 1
 * elsewhere. chi is the indicator of the known part: 0 where data are missing, 1 elsewhere. D has
 * the factors AlongDiffusivity and AcrossDiffusivity, 1 by default. kappa is 1e-6. All components
 * of the data, as the channels of a colour, share v.
 *
 * The coefficients follow from three quantities that have a meaning for the data:
 *
 * - SmoothingLength: data are smoothed over this length between edges, lambda =
 *   FidelityWeight/SmoothingLength^2;
 * - EdgeThreshold: a smaller jump is smoothed, a larger one is an edge, beta = EdgeThreshold^2/(4
 *   SmoothingLength)/(1 + h/(4 EdgeWidth)); the last factor is what an edge costs too much on a
 *   mesh, on which two vertices have v = 0 across it;
 * - EdgeWidth: eps, the width of the transition of v, which is 1 - exp(-d/(2 eps)) at the distance
 *   d from an edge.
 *
 * **AutomaticThreshold** (default: on) finds EdgeThreshold J and SmoothingLength L for each
 * connected component, from the noise sigma, the range R of the component's values without the
 * outermost 0.1 % at either end, and the slope g of the data between their jumps, all in the
 * Euclidean norm over the components of the array:
 *
 *     J = max(0.12 R, 3.2 sigma sqrt(8 h / L), g max(sqrt(24 eps L), 2 L)),
 *
 * so that neither noise nor slopes become edges. L is what noise needs for J = 0.12 R, in 4 h to 24
 * h. If slopes then ask for a larger J, then L is shorter, down to 2 h, where noise and slopes ask
 * for the same J. White noise of 10 % of the range, in data with jumps of 25 %, leaves 85 % of the
 * edges or more. GetEffectiveEdgeThreshold() and GetEffectiveSmoothingLength() return what was
 * found. The edges then form with eps = EdgeWidth from the start.
 *
 * With AutomaticThreshold off, noise with a standard deviation above a third of EdgeThreshold makes
 * edges everywhere, in the Euclidean norm over all components, and so do slopes above
 * EdgeThreshold/(2 SmoothingLength): the gradient limit of the functional (A. Blake, A. Zisserman,
 * Visual Reconstruction, 1987), for which a staircase costs less than a slope. A
 * warning says which of both it is if more than 30 % of the surface is an edge, or else that edges
 * are close together for EdgeWidth.
 *
 * Missing data are filled in with edges that continue through the hole; the start there is harmonic
 * (InitialFill), since a start with jumps at the hole would keep them. Fixed values act on u.
 *
 * A time step minimises E over u, then over v. Both are linear systems, which are solved for the
 * change up to Tolerance (default: 0.1), a part of the residual at the start of the solve; to 1e-3
 * at most if data are missing. The energy falls in every
 * half step on any mesh and with any tolerance. The steps end when one lowers the energy by less
 * than StopTolerance. With AutomaticThreshold off they start with eps = 4 EdgeWidth, which is
 * halved twice, each time when a step lowers the energy by less than 100 times StopTolerance. Some
 * 30 steps are usual, and up to 300 if jumps are near EdgeThreshold. The unit of time is 1: steps
 * have no physical time.
 *
 * E is not convex, and the result is a local minimum.
 * 0 <= v <= 1 holds for the exact v on Delaunay meshes (IntrinsicDelaunay); on others v may leave
 * the interval, and `Edges` is clamped.
 *
 * **Output port 0**: the result, named as the data with the suffix `MumfordShah`, and the array
 * `Edges`, 1 - v, or, for data on cells, its mean over the cell. ResultArrayName, if it is not
 * empty, is the name of the result and the prefix of `Edges`. **Output port 1**: the history; its
 * energy is E with the eps of the step, in (units of the array)^2: it can rise in the two steps
 * where eps is halved. **Output port 2**: the edges as polylines (vtkPolyData), one per edge
 * between its ends and junctions, along the ridge of 1 - v; a closed edge repeats its first point.
 * It has the point array `Edges` and the cell arrays `Length`, in coordinate units, and `Block`,
 * the number of the surface in composite data, whose curves are in one output. Edges shorter than 4
 * EdgeWidth are left out. Curves need the whole surface: with EdgeCurves on, surfaces in pieces are
 * gathered and solved in process 0, whose port 2 has the curves.
 *
 * Without missing, fixed or held values the sum of A_i u_i is conserved to a relative error of
 * 1e-12.
 *
 * @sa vtkIntrinsicTVFilter vtkFVMHeatFilter
 */
#ifndef vtkMumfordShahFilter_h
#define vtkMumfordShahFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkMumfordShahFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkMumfordShahFilter* New();
  vtkTypeMacro(vtkMumfordShahFilter, vtkSurfaceDataDiffusionAlgorithm);

  /**
   * On (default): EdgeThreshold and SmoothingLength are found from the data, for each connected
   * component and each block of composite data, and the given ones are ignored, with a warning if
   * they were set. Surfaces in pieces are then gathered and solved in process 0.
   */
  SURFACEDIFFUSION_SWITCH(AutomaticThreshold);

  /**
   * The standard deviation of the noise for AutomaticThreshold, in the array's own units regardless
   * of Units, of one component of the array. 0 (default): estimated from the data, for white noise
   * or noise that is correlated over a few edges.
   */
  SURFACEDIFFUSION_PROPERTY(NoiseLevel, double);

  /**
   * The jump from which on an edge costs less than smoothing, with AutomaticThreshold off: jumps
   * below 0.9 of it are smoothed, jumps above 1.25 of it are kept. Natural units: in R. Positive.
   * Default: 0.2.
   */
  SURFACEDIFFUSION_PROPERTY(EdgeThreshold, double);

  /**
   * The length over which data are smoothed between edges, with AutomaticThreshold off. Natural
   * units: in h. Positive. Default: 8. FidelityWeight (default: 1) is a factor of lambda beside it.
   */
  SURFACEDIFFUSION_PROPERTY(SmoothingLength, double);

  /**
   * eps, the width of the transition of v beside an edge. Natural units: in h. Positive; below h
   * the triangles do not resolve it, which gives a warning. Default: 2.
   */
  SURFACEDIFFUSION_PROPERTY(EdgeWidth, double);

  /**
   * The relative decrease of the energy in one step at which the run ends, before
   * NumberOfTimeSteps (default: 1000). In (0, 1). Default: 1e-5.
   */
  SURFACEDIFFUSION_PROPERTY(StopTolerance, double);

  /**
   * On (default): output port 2 has the edges as curves.
   */
  SURFACEDIFFUSION_SWITCH(EdgeCurves);

  ///@{
  /**
   * The EdgeThreshold and the SmoothingLength of the last update, in the units of these properties,
   * given or found by AutomaticThreshold; and the standard deviation of the noise that it used, in
   * the array's own units, 0 with AutomaticThreshold off. All are those of the connected component
   * with the most points, and for composite data of the first block.
   */
  SURFACEDIFFUSION_NUMBER(EffectiveEdgeThreshold, double);
  SURFACEDIFFUSION_NUMBER(EffectiveSmoothingLength, double);
  SURFACEDIFFUSION_NUMBER(EstimatedNoiseLevel, double);
  ///@}

  /**
   * The length of all curves of the last update, in coordinate units.
   */
  SURFACEDIFFUSION_NUMBER(EdgeLength, double);

protected:
  vtkMumfordShahFilter();
  ~vtkMumfordShahFilter() override;

private:
  vtkMumfordShahFilter(const vtkMumfordShahFilter&) = delete;
  void operator=(const vtkMumfordShahFilter&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
