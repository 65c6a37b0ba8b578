// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDiffusionAlgorithm
 * @brief   superclass of the time-dependent models: time steps, their solver, history
 *
 * The subclasses solve diffusion equations in time steps, each with linear systems. This class adds
 * time to vtkSurfaceModelAlgorithm, which defines arrays, units, masks and results. With Mode
 * SteadyState, which some classes have, no times are published, and the history has two rows: the
 * start and the steady state.
 *
 * **Output port 1** is a vtkTable, the history: row 0 is the initial state, then one row per step
 * with columns `Step`, `Time`, `Total_0` ... (sum of A_i u_i of each component), `Energy`,
 * `Iterations`, `Residual`, `Seconds`.
 *
 * Results do not depend on the order in which times are requested.
 *
 * @sa vtkSurfaceModelAlgorithm vtkSurfaceDataDiffusionAlgorithm vtkTuringTextureFilter
 */
#ifndef vtkSurfaceDiffusionAlgorithm_h
#define vtkSurfaceDiffusionAlgorithm_h

#include "vtkSurfaceModelAlgorithm.h"

namespace SurfaceDiffusion
{
class RunLength;
struct TimeSettings;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDiffusionAlgorithm : public vtkSurfaceModelAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceDiffusionAlgorithm, vtkSurfaceModelAlgorithm);

  /**
   * The time step, in the unit that Units selects. Positive. Default: 1, unless the class has another.
   */
  SURFACEDIFFUSION_PROPERTY(TimeStep, double);

  /**
   * The number of time steps n. There are n + 1 states, from the initial one on. 0 to 1e9.
   * Default: 10, likewise. If only this number is raised, the next update computes the new steps alone,
   * unless a run of that length has another solver with Solver Automatic.
   */
  SURFACEDIFFUSION_PROPERTY(NumberOfTimeSteps, int);

  /**
   * On: the output has time steps, one per OutputInterval steps of the run, and any time can be
   * requested. Between two time steps the output is the earlier one, outside their range it is the
   * nearest one. A run that ends early, by a StopTolerance, is computed to its end by the first
   * update, after which only the times that it has are published; before, those of
   * NumberOfTimeSteps are. The input is then requested once, at its own first time if it has times,
   * with a warning if it has several. A steady state has no times: On has no effect with Mode
   * SteadyState. Off (default): the output is the final state, and the input's time passes through.
   */
  SURFACEDIFFUSION_SWITCH(GenerateTimeSteps);

  /**
   * The interval k of the published times with GenerateTimeSteps, which are those of steps 0, k, 2
   * k, ... and the last one. 1 or more. Default: 1.
   */
  SURFACEDIFFUSION_PROPERTY(OutputInterval, int);

  /// The values of the property TimeIntegrator, which the classes with a choice of them have.
  enum TimeIntegratorType
  {
    TIME_INTEGRATOR_FIRST_ORDER = 0,
    TIME_INTEGRATOR_SECOND_ORDER = 1,
    TIME_INTEGRATOR_IMPLICIT = 2,
    TIME_INTEGRATOR_EXPONENTIAL = 3,
    TIME_INTEGRATOR_AUTOMATIC = 4
  };

  enum SolverType
  {
    SOLVER_AUTOMATIC = 0,
    SOLVER_DIRECT = 1,
    SOLVER_CONJUGATE_GRADIENT = 2,
    SOLVER_MULTIGRID = 3
  };

  ///@{
  /**
   * The solver of linear systems. Direct: sparse Cholesky factorisation, which is kept while the
   * matrix does not change. ConjugateGradient: conjugate gradients with Jacobi preconditioner, as
   * in the paper, which also solves along lines across narrow triangles. Multigrid: conjugate
   * gradients with smoothed aggregation as preconditioner; the number of iterations hardly grows
   * with the size and the time step. Automatic (default): the solver that is expected to be the
   * fastest for the size, the time step and the number of steps, according to measurements. Where
   * narrow triangles keep the iterations of Automatic or Multigrid from converging, another solver
   * takes over, at last Direct.
   */
  SURFACEDIFFUSION_CHOICE(Solver);
  void SetSolverToAutomatic() { this->SetSolver(SOLVER_AUTOMATIC); }
  void SetSolverToDirect() { this->SetSolver(SOLVER_DIRECT); }
  void SetSolverToConjugateGradient() { this->SetSolver(SOLVER_CONJUGATE_GRADIENT); }
  void SetSolverToMultigrid() { this->SetSolver(SOLVER_MULTIGRID); }
  ///@}

  ///@{
  /**
   * The relative residual, in the norm of the inverse diagonal, at which iterative solvers stop, in
   * (0, 1), and the largest number of iterations, 1 or more. A solve that stops above ten times
   * Tolerance is an error, and one that stops above it gives a warning. Default: 1e-6 (1e-10 in
   * vtkTuringTextureFilter, whose instability amplifies errors, 1e-3 in vtkIntrinsicTVFilter, 0.1
   * in vtkMumfordShahFilter), 1000. Two kinds of solves go on to less. A step of vtkFVMHeatFilter
   * goes on to a tenth of it, or less where triangles are much smaller than on average, but not
   * below 1e-10, so that ten steps change by about Tolerance times the range of the data. The
   * harmonic function that fills holes, and a steady state of vtkFVMHeatFilter, go on to 1e-10,
   * since their errors exceed residuals by far.
   */
  SURFACEDIFFUSION_PROPERTY(Tolerance, double);
  SURFACEDIFFUSION_PROPERTY(MaximumNumberOfIterations, int);
  ///@}

  /**
   * The memory in MiB for states that are kept with GenerateTimeSteps so that going back in time is
   * cheap. 0 or more. Default: 512.
   */
  SURFACEDIFFUSION_PROPERTY(CheckpointMemoryLimit, int);

  /**
   * Select the paper's scheme: IntrinsicDelaunay off, MaskMode Inpaint, TimeIntegrator FirstOrder
   * in classes that have it, and the settings that subclasses add. Units, times, weights and the
   * solver do not change.
   */
  virtual void UsePaperScheme();

  /**
   * The time step that the run uses, in the unit of TimeStep.
   */
  double GetEffectiveTimeStep();

  ///@{
  /**
   * Values of the last update: the unit of time in coordinate and array units (exactly 1 in
   * Absolute), and the total number of time steps computed in the life of the filter (for
   * profiling).
   */
  SURFACEDIFFUSION_NUMBER(TimeUnit, double);
  SURFACEDIFFUSION_NUMBER(NumberOfStepsComputed, vtkIdType);
  ///@}

protected:
  /// settings: of a class derived from SurfaceDiffusion::TimeSettings.
  explicit vtkSurfaceDiffusionAlgorithm(SurfaceDiffusion::OwnedSettings settings);
  ~vtkSurfaceDiffusionAlgorithm() override;

  SurfaceDiffusion::TimeSettings& GetTimeSettings() const;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSurfaceDiffusionAlgorithm(const vtkSurfaceDiffusionAlgorithm&) = delete;
  void operator=(const vtkSurfaceDiffusionAlgorithm&) = delete;

  bool PublishesTimes() const;

  /// The end of the run, which may have come before the last step.
  const std::unique_ptr<SurfaceDiffusion::RunLength> KnownLength;
};
VTK_ABI_NAMESPACE_END

#endif
