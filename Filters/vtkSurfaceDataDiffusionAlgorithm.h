// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDataDiffusionAlgorithm
 * @brief   superclass of the models of given data: fidelity, diffusivities, missing data
 *
 * The subclasses solve diffusion equations for given data f on a surface,
 *
 *     u_t = div(D grad u) + lambda chi (f - u),
 *
 * with the diffusion tensor D of each model and the indicator chi of the known part: 0 where data
 * are missing, 1 elsewhere. See vtkSurfaceModelAlgorithm for arrays and
 * units, and vtkSurfaceDiffusionAlgorithm for time.
 *
 * **Fidelity per point or cell.** Input array 5, FidelityArray, is an optional array of one
 * component whose values w >= 0 multiply lambda, for data that are not equally reliable: with noise
 * of standard deviation s_i at point i, w_i is proportional to 1/s_i^2. In time steps, a point with
 * w = 0 starts from its value, which has no further effect; a steady state and the edges of
 * vtkMumfordShahFilter do not depend on it, so that it is missing. If w varies, the sum of A_i u_i is
 * not conserved.
 * Factors of cells are averaged at the points if the data are on points; if they are on cells, too,
 * P f is the mean weighted by them. With AutomaticFidelity the noise has the variance s^2/w, with
 * s = NoiseLevel or an estimate, and the mean of w times the squared difference from the data, in
 * each connected component and weighted by area, is s^2.
 *
 * @sa vtkFVMHeatFilter vtkIntrinsicTVFilter vtkHarmonicMapFilter
 */
#ifndef vtkSurfaceDataDiffusionAlgorithm_h
#define vtkSurfaceDataDiffusionAlgorithm_h

#include "vtkSurfaceDiffusionAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDataDiffusionAlgorithm
  : public vtkSurfaceDiffusionAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceDataDiffusionAlgorithm, vtkSurfaceDiffusionAlgorithm);

  /**
   * The weight lambda of the fidelity term lambda chi (f - u) of (16) to (19), in 1/(unit of time).
   * Input array 5 multiplies it point by point. 0 or more. Default: 0.
   */
  SURFACEDIFFUSION_PROPERTY(FidelityWeight, double);

  enum InitialFillType
  {
    INITIAL_FILL_INPUT = 0,
    INITIAL_FILL_MEAN = 1,
    INITIAL_FILL_NOISE = 2,
    INITIAL_FILL_HARMONIC = 3
  };

  ///@{
  /**
   * The initial values at missing points. Input: the damaged values themselves, as in the paper, or
   * Mean if they are NaN. Mean: the mean of the known values of the connected component. Noise: the
   * paper's random guess, uniform between the smallest and largest known value of the component of
   * the data. Harmonic: the harmonic function of the known values, which satisfies Laplace's
   * equation of the surface at missing points, so that smoothing is not biased at holes (unit
   * vectors are normalised; line fields take Mean). Default: Mean; of vtkFVMHeatFilter
   * and vtkMumfordShahFilter Harmonic.
   */
  SURFACEDIFFUSION_CHOICE(InitialFill);
  void SetInitialFillToInput() { this->SetInitialFill(INITIAL_FILL_INPUT); }
  void SetInitialFillToMean() { this->SetInitialFill(INITIAL_FILL_MEAN); }
  void SetInitialFillToNoise() { this->SetInitialFill(INITIAL_FILL_NOISE); }
  void SetInitialFillToHarmonic() { this->SetInitialFill(INITIAL_FILL_HARMONIC); }
  ///@}

  /**
   * On: known points keep their value exactly (lambda = infinity), so that only missing points
   * change. It is an error if nothing is missing. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(HoldKnownValues);

  ///@{
  /**
   * The factors of the diffusivity along the direction e1 and across it (along e2). g1 and g2 of
   * (4) are these factors times g(|grad u|), with g = 1 for linear diffusion. 0 or more. Different
   * values need the direction array, input array 2. Default: 1, 1.
   */
  SURFACEDIFFUSION_PROPERTY(AlongDiffusivity, double);
  SURFACEDIFFUSION_PROPERTY(AcrossDiffusivity, double);
  ///@}

  /**
   * On (default): the result of data on cells is on cells. Off: it is u at the points. No effect on
   * point data.
   */
  SURFACEDIFFUSION_SWITCH(ResultOnCells);

  /**
   * On (default): a result on cells is P* u + d, see vtkSurfaceModelAlgorithm: the detail d that
   * the points do not resolve, of white noise on triangles 87 %, diffuses beside u with the same
   * diffusion tensor and fidelity. A model that changes nothing returns f. With an L1 norm, lambda
   * of d is divided by the distance of the result to f; the models of colours take D and lambda of
   * the brightness, and deblurring restores no detail. Off: the result is P* u, the mean of u over
   * each cell, which zero steps smooth, too. Both keep constants and the integral.
   */
  SURFACEDIFFUSION_SWITCH(KeepCellDetail);

  /**
   * In addition to the superclass: HoldKnownValues off, InitialFill Input.
   */
  void UsePaperScheme() override;

protected:
  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;

  /// settings: of a class derived from SurfaceDiffusion::DataSettings.
  explicit vtkSurfaceDataDiffusionAlgorithm(SurfaceDiffusion::OwnedSettings settings);
  ~vtkSurfaceDataDiffusionAlgorithm() override = default;

private:
  vtkSurfaceDataDiffusionAlgorithm(const vtkSurfaceDataDiffusionAlgorithm&) = delete;
  void operator=(const vtkSurfaceDataDiffusionAlgorithm&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
