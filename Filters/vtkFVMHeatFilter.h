// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFVMHeatFilter
 * @brief   linear diffusion of point data on a triangulated surface
 *
 * Solves the heat equation on the surface with the finite volume method of C. Wu, J. Deng and
 * F. Chen (IEEE TVCG 14(3), 2008):
 *
 *     u_t = div(g1 (grad u . e1) e1 + g2 (grad u . e2) e2) + lambda chi (f - u),   u(0) = f,
 *
 * with no flux over the boundary. Its cases are the paper's (1) smoothing (lambda = 0, g1 = g2),
 * (4) anisotropic smoothing along a direction field, (16) denoising (lambda > 0) and (18)
 * inpainting (1_D = 0 where data are missing). Each component of the data diffuses alone.
 *
 * Diffusion for time t is a Gaussian blur of full width at half maximum 4 sqrt(t ln 2), whatever
 * the triangles: FWHM sets that width directly.
 *
 * The unit of time in natural units is h^2 (h the mean edge length): diffusivities have no unit,
 * lambda is in 1/h^2. The discretisation is
 *
 *     A_i du_i/dt = sum over triangles and j of c_ij u_j + A_i lambda 1_D(v_i) (f_i - u_i),
 *
 * A_i the barycentric control areas, c_ij of (10) and (13); without fidelity, fixed or held values
 * the sum of A_i u_i is kept to 1e-12 of its start.
 *
 * TimeIntegrator SecondOrder (the default) is SDIRK2 with gamma = 1 - 1/sqrt(2) (R. Alexander, SIAM
 * J. Numer. Anal. 14, 1977): two solves a step with one matrix, L-stable; to an error of 1e-3 it
 * takes 3 to 4 steps where FirstOrder, backward Euler as in (8), (14), takes about 100. Backward
 * Euler keeps the bounds of the data on Delaunay meshes at any step, SDIRK2 at small ones only.
 *
 * The energy in the history is 1/2 int (g1 (grad u . e1)^2 + g2 (grad u . e2)^2) + lambda/2
 * int chi (u - f)^2, summed over the components, in (units of the array)^2.
 *
 * @sa vtkIntrinsicTVFilter vtkHarmonicMapFilter vtkTuringTextureFilter
 */
#ifndef vtkFVMHeatFilter_h
#define vtkFVMHeatFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

class VTKSURFACEDIFFUSION_EXPORT vtkFVMHeatFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkFVMHeatFilter* New();
  vtkTypeMacro(vtkFVMHeatFilter, vtkSurfaceDataDiffusionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ModeType
  {
    MODE_TIME_STEPS = 0,
    MODE_STEADY_STATE = 1
  };

  ///@{
  /**
   * TimeSteps (default): NumberOfTimeSteps steps of TimeStep. SteadyState: the limit of endless
   * time, found with one solve, which counts as one step: with fixed or held values the harmonic
   * inpainting, with lambda the minimiser of the energy, with neither the mean of each connected
   * component.
   */
  vtkSetMacro(Mode, int);
  vtkGetMacro(Mode, int);
  void SetModeToTimeSteps() { this->SetMode(MODE_TIME_STEPS); }
  void SetModeToSteadyState() { this->SetMode(MODE_STEADY_STATE); }
  const char* GetModeAsString();
  ///@}

  ///@{
  /**
   * Full width at half maximum of the Gaussian that the data are blurred with, in coordinate
   * units; 0 (default): off. The run then takes FWHM^2/(16 ln 2) in NumberOfTimeSteps equal steps
   * in place of TimeStep, and times are in coordinate units squared, whatever Units is. An error
   * together with a fidelity, diffusivities other than 1, or Mode SteadyState.
   */
  vtkSetMacro(FWHM, double);
  vtkGetMacro(FWHM, double);
  ///@}

  ///@{
  /**
   * On: lambda is chosen so that in the steady state of (16) the result differs from the data by
   * the noise, in the root of the area-weighted mean square (discrepancy principle, Morozov 1966);
   * FidelityWeight is not read. The principle errs on the smooth side: on photographs under noise
   * of 5 to 80 % its result was 1.3 to 2.6 dB from that of the best lambda. Default: off.
   */
  vtkSetMacro(AutomaticFidelity, bool);
  vtkGetMacro(AutomaticFidelity, bool);
  vtkBooleanMacro(AutomaticFidelity, bool);
  ///@}

  ///@{
  /**
   * With AutomaticFidelity: the standard deviation of the noise in the array's own units, whatever
   * Units is. 0 (default): estimated from the median difference of each value from the mean of its
   * neighbours.
   */
  vtkSetMacro(NoiseLevel, double);
  vtkGetMacro(NoiseLevel, double);
  ///@}

  /**
   * The lambda of the last update: FidelityWeight, or what AutomaticFidelity found (for the first
   * block of composite data; each block has its own), in the unit of FidelityWeight.
   */
  vtkGetMacro(EffectiveFidelityWeight, double);

  void UsePaperScheme() override;

protected:
  vtkFVMHeatFilter();
  ~vtkFVMHeatFilter() override = default;

  std::unique_ptr<SurfaceDiffusion::RunSettings> MakeSettings() const override;
  void TakeResults() override;
  void VisitReported(const std::function<void(double&)>& visit) override;
  const char* GetResultSuffix() const override { return "Diffused"; }

  int Mode = MODE_TIME_STEPS;
  double FWHM = 0.0;
  bool AutomaticFidelity = false;
  double NoiseLevel = 0.0;
  double EffectiveFidelityWeight = 0.0;

private:
  vtkFVMHeatFilter(const vtkFVMHeatFilter&) = delete;
  void operator=(const vtkFVMHeatFilter&) = delete;
};

#endif
