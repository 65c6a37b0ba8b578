// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDataDiffusionAlgorithm
 * @brief   superclass of the models that start from given data: fidelity, diffusivities, missing
 * data
 *
 * The models below this class evolve given data f on a surface,
 *
 *     u_t = div(D grad u) + lambda chi (f - u),
 *
 * with chi the indicator of the known part, in one form or another. See
 * vtkSurfaceDiffusionAlgorithm for arrays, units and time.
 *
 * @sa vtkFVMHeatFilter vtkIntrinsicTVFilter vtkHarmonicMapFilter
 */
#ifndef vtkSurfaceDataDiffusionAlgorithm_h
#define vtkSurfaceDataDiffusionAlgorithm_h

#include "vtkSurfaceDiffusionAlgorithm.h"

namespace SurfaceDiffusion
{
struct DataSettings;
}

class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDataDiffusionAlgorithm
  : public vtkSurfaceDiffusionAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceDataDiffusionAlgorithm, vtkSurfaceDiffusionAlgorithm);

  ///@{
  /**
   * lambda of (16) to (19), the weight of lambda chi (f - u), with chi the indicator of the known
   * part, in 1/(unit of time). 0 or more. Default: 0.
   */
  vtkSetMacro(FidelityWeight, double);
  vtkGetMacro(FidelityWeight, double);
  ///@}

  enum InitialFillType
  {
    INITIAL_FILL_INPUT = 0,
    INITIAL_FILL_MEAN = 1,
    INITIAL_FILL_NOISE = 2
  };

  ///@{
  /**
   * What missing points start from. Input: the damaged values themselves, as in the paper (Mean
   * where they are NaN). Mean (default): the mean of the known values of the connected component.
   * Noise: the paper's random guess, uniform between the smallest and largest known value of the
   * component of the data.
   */
  vtkSetMacro(InitialFill, int);
  vtkGetMacro(InitialFill, int);
  void SetInitialFillToInput() { this->SetInitialFill(INITIAL_FILL_INPUT); }
  void SetInitialFillToMean() { this->SetInitialFill(INITIAL_FILL_MEAN); }
  void SetInitialFillToNoise() { this->SetInitialFill(INITIAL_FILL_NOISE); }
  const char* GetInitialFillAsString();
  ///@}

  ///@{
  /**
   * On: known points keep their value exactly (lambda = infinity) and only what is missing is
   * filled. An error where nothing is missing. Default: off.
   */
  vtkSetMacro(HoldKnownValues, bool);
  vtkGetMacro(HoldKnownValues, bool);
  vtkBooleanMacro(HoldKnownValues, bool);
  ///@}

  ///@{
  /**
   * Factors of the diffusivity along the direction e1 and across it (along e2): g1 and g2 of (4)
   * are these times g(|grad u|), and g = 1 for linear diffusion. 0 or more; different values need
   * the direction array, input array 2. Default: 1, 1.
   */
  vtkSetMacro(AlongDiffusivity, double);
  vtkGetMacro(AlongDiffusivity, double);
  vtkSetMacro(AcrossDiffusivity, double);
  vtkGetMacro(AcrossDiffusivity, double);
  ///@}

  /**
   * In addition to the superclass: HoldKnownValues off, InitialFill Input.
   */
  void UsePaperScheme() override;

protected:
  vtkSurfaceDataDiffusionAlgorithm() = default;
  ~vtkSurfaceDataDiffusionAlgorithm() override = default;

  void CopyProperties(SurfaceDiffusion::DataSettings& settings) const;

  double FidelityWeight = 0.0;
  int InitialFill = INITIAL_FILL_MEAN;
  bool HoldKnownValues = false;
  double AlongDiffusivity = 1.0;
  double AcrossDiffusivity = 1.0;

private:
  vtkSurfaceDataDiffusionAlgorithm(const vtkSurfaceDataDiffusionAlgorithm&) = delete;
  void operator=(const vtkSurfaceDataDiffusionAlgorithm&) = delete;
};

#endif
