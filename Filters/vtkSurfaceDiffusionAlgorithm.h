// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDiffusionAlgorithm
 * @brief   what the surface diffusion filters share: arrays, units, time, constraints, solvers
 *
 * Superclass of the filters that solve diffusion equations on triangulated surfaces (C. Wu,
 * J. Deng, F. Chen, "Diffusion Equations over Arbitrary Triangulated Surfaces for Filtering and
 * Texture Applications", IEEE TVCG 14(3), 2008). The surface may have any angles and any topology.
 * Data are point data, piecewise linear on the triangles; each vertex has the barycentric control
 * cell of area A_i around it, and nothing flows over the boundary of the surface.
 *
 * **Input arrays**, `SetInputArrayToProcess(idx, 0, 0, association, name)`; an empty name means
 * not set:
 *
 * | idx | association | meaning |
 * | --- | --- | --- |
 * | 0 | points | the data f: any numeric type and number of components. Unsigned chars are colours;
 * with 2 or 4 components the last is alpha and carried over. Default: the active scalars | | 1 |
 * points | mask, one component: nonzero is missing or excluded, see MaskMode. A point is missing
 * too where any component of f is NaN | | 2 | points or cells | direction e1, three components:
 * projected into each triangle and normalised, e2 = n x e1. The sign does not matter. Zero or NaN:
 * isotropic there with the geometric mean of the two diffusivities | | 3 | points | nonzero: the
 * value is held fixed (Dirichlet). Fixed beats missing |
 *
 * Polygons and strips are triangulated inside; vertices and lines pass through; ghost and hidden
 * cells take no part. Composite input is one problem with one set of units; each block is a
 * surface of its own.
 *
 * **Surfaces in pieces.** The processes of Controller (pvbatch, pvserver, MPI programs), each with
 * a piece, and the partitions of a vtkPartitionedDataSet, give the answer of the surface in one
 * piece, whatever the partition. All processes update together. Points of different pieces are one
 * point of the surface where they have one global id, if all pieces have global ids; otherwise
 * where they lie at one place, within SeamTolerance, and at least one of them lies on the edge of
 * its piece. Points of one piece are never joined (that is what MergeCoincidentPoints does): of
 * several at one place the k-th goes with the k-th of other pieces. Data are those of the first
 * piece that has the point. Ghost cells take no part; ghost points get the results of the points
 * that they are copies of. The history, warnings and errors are those of process 0 alone. Random
 * numbers are those of one process where there are global ids; they depend on the coordinates
 * otherwise.
 *
 * Each process solves with its piece, so that memory and time are divided, where the library was
 * built with hypre, the surface has one piece per process, IntrinsicDelaunay and
 * MergeCoincidentPoints are off, and Solver is ConjugateGradient or Multigrid (hypre's BoomerAMG),
 * or Automatic and there are more than a million points. An abort is then obeyed by all of them
 * within a few iterations. Solved in process 0, which then holds the whole surface, are also:
 * AutomaticFidelity; of vtkIntrinsicTVFilter Discretization CrouzeixRaviart; of
 * vtkHarmonicMapFilter MoveVertices, normals that it has to compute, and lines some of which are
 * missing; and vtkSurfaceDirectionFieldFilter.
 *
 * **Output port 0** is the input with the result as a further point array, made active. Points
 * that no participating triangle uses keep their value. **Output port 1** is a vtkTable, the
 * history: row 0 is the initial state, then one row per step with columns `Step`, `Time`,
 * `Total_0` ... (sum of A_i u_i of each component), `Energy`, `Iterations`, `Residual`, `Seconds`.
 *
 * **Bad properties or arrays** are errors at update that name the property, its value and what is
 * allowed; the output then is the unchanged input. What a surface has wrong (zero-area triangles,
 * non-manifold edges, unused or coincident points) is handled and told in one warning with counts.
 *
 * Results do not depend on the number of threads or on the order in which times are asked for.
 */
#ifndef vtkSurfaceDiffusionAlgorithm_h
#define vtkSurfaceDiffusionAlgorithm_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSurfaceDiffusionModule.h" // for export macro

#include <functional> // for read-only values
#include <iosfwd> // for the key of a run
#include <memory> // for the private part
#include <string> // for messages
#include <vector> // for messages

namespace SurfaceDiffusion
{
class GatheredSurfaces;
class Model;
class Processes;
class ProgressMonitor;
struct BlockArrays;
struct ModelInput;
struct SurfacePiece;
struct SurfaceRun;
}
class vtkDataArray;
class vtkMultiProcessController;
class vtkPolyData;
class vtkTable;

class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDiffusionAlgorithm : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceDiffusionAlgorithm, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The time step, in the unit that Units selects. Positive. Default: 1.
   */
  vtkSetMacro(TimeStep, double);
  vtkGetMacro(TimeStep, double);
  ///@}

  ///@{
  /**
   * The number of time steps n: there are n + 1 states, from the initial one on. 0 to 1e9.
   * Default: 10.
   */
  vtkSetMacro(NumberOfTimeSteps, int);
  vtkGetMacro(NumberOfTimeSteps, int);
  ///@}

  enum UnitsType
  {
    UNITS_NATURAL = 0,
    UNITS_ABSOLUTE = 1
  };

  ///@{
  /**
   * The units of times, weights and thresholds. Absolute: lengths and values as they come. Natural
   * (default): lengths in h, the mean length of the distinct edges of triangles of positive area,
   * and values in R, the largest over the components of max - min of the known values (1 if that
   * is 0), so that one setting suits any mesh and any array. Each class says what its unit of time
   * is; see GetTimeUnit().
   */
  vtkSetMacro(Units, int);
  vtkGetMacro(Units, int);
  void SetUnitsToNatural() { this->SetUnits(UNITS_NATURAL); }
  void SetUnitsToAbsolute() { this->SetUnits(UNITS_ABSOLUTE); }
  const char* GetUnitsAsString();
  ///@}

  ///@{
  /**
   * On: the output has time steps, one per OutputInterval steps of the run, and any time can be
   * asked for: between two the earlier is given, outside them the nearest. The input is then asked
   * for once, at its own first time if it has times. Off (default): the output is the final state,
   * and the input's time passes through.
   */
  vtkSetMacro(GenerateTimeSteps, bool);
  vtkGetMacro(GenerateTimeSteps, bool);
  vtkBooleanMacro(GenerateTimeSteps, bool);
  ///@}

  ///@{
  /**
   * With GenerateTimeSteps: the published times are those of steps 0, k, 2 k, ... and the last.
   * 1 or more. Default: 1.
   */
  vtkSetMacro(OutputInterval, int);
  vtkGetMacro(OutputInterval, int);
  ///@}

  ///@{
  /**
   * lambda of (16) to (19), the weight of lambda 1_D (f - u), in 1/(unit of time). 0 or more.
   * Default: 0.
   */
  vtkSetMacro(FidelityWeight, double);
  vtkGetMacro(FidelityWeight, double);
  ///@}

  enum MaskModeType
  {
    MASK_MODE_INPAINT = 0,
    MASK_MODE_EXCLUDE = 1
  };

  ///@{
  /**
   * What the mask means. Inpaint (default): masked points are missing and are filled in, (18) and
   * (19). Exclude: triangles with a masked vertex take no part, nothing flows across, and masked
   * points keep their value: the rest is a region of interest.
   */
  vtkSetMacro(MaskMode, int);
  vtkGetMacro(MaskMode, int);
  void SetMaskModeToInpaint() { this->SetMaskMode(MASK_MODE_INPAINT); }
  void SetMaskModeToExclude() { this->SetMaskMode(MASK_MODE_EXCLUDE); }
  const char* GetMaskModeAsString();
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
   * Seed of all random numbers. They are a hash of the seed, the component and the point's global
   * id (its index without global ids): the same bits everywhere. Default: 0.
   */
  vtkSetMacro(RandomSeed, int);
  vtkGetMacro(RandomSeed, int);
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

  enum TimeIntegratorType
  {
    TIME_INTEGRATOR_FIRST_ORDER = 0,
    TIME_INTEGRATOR_SECOND_ORDER = 1,
    TIME_INTEGRATOR_IMPLICIT = 2
  };

  ///@{
  /**
   * The time integrator: each class says which it has and which is its default. FirstOrder is the
   * paper's. Second-order schemes do not keep the bounds of the data at large steps.
   */
  vtkSetMacro(TimeIntegrator, int);
  vtkGetMacro(TimeIntegrator, int);
  void SetTimeIntegratorToFirstOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_FIRST_ORDER); }
  void SetTimeIntegratorToSecondOrder() { this->SetTimeIntegrator(TIME_INTEGRATOR_SECOND_ORDER); }
  const char* GetTimeIntegratorAsString();
  ///@}

  enum SolverType
  {
    SOLVER_AUTOMATIC = 0,
    SOLVER_DIRECT = 1,
    SOLVER_CONJUGATE_GRADIENT = 2,
    SOLVER_MULTIGRID = 3
  };

  ///@{
  /**
   * How linear systems are solved. Direct: sparse Cholesky factorisation, kept while the matrix
   * stays. ConjugateGradient: with Jacobi preconditioner, the paper's. Multigrid: conjugate
   * gradients with smoothed aggregation, whose iterations hardly grow with size and time step.
   * Automatic (default): the fastest of them for the size, the step and the number of steps, by
   * measurement.
   */
  vtkSetMacro(Solver, int);
  vtkGetMacro(Solver, int);
  void SetSolverToAutomatic() { this->SetSolver(SOLVER_AUTOMATIC); }
  void SetSolverToDirect() { this->SetSolver(SOLVER_DIRECT); }
  void SetSolverToConjugateGradient() { this->SetSolver(SOLVER_CONJUGATE_GRADIENT); }
  void SetSolverToMultigrid() { this->SetSolver(SOLVER_MULTIGRID); }
  const char* GetSolverAsString();
  ///@}

  ///@{
  /**
   * Where iterative solvers stop: relative residual, in the norm of the inverse diagonal. In
   * (0, 1). Default: 1e-10, in vtkIntrinsicTVFilter 1e-3. And the most iterations, 1 or more,
   * default 1000: not to converge in them is an error.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  vtkSetMacro(MaximumNumberOfIterations, int);
  vtkGetMacro(MaximumNumberOfIterations, int);
  ///@}

  ///@{
  /**
   * On: work on the intrinsic Delaunay triangulation of the same surface: no vertex moves, edges
   * are flipped along geodesics, over two sheets where the surface has a boundary or is not a
   * manifold (N. Sharp, K. Crane, SGP 2020). Linear diffusion FirstOrder then keeps the bounds of
   * the data at any time step on any surface. Default: off.
   */
  vtkSetMacro(IntrinsicDelaunay, bool);
  vtkGetMacro(IntrinsicDelaunay, bool);
  vtkBooleanMacro(IntrinsicDelaunay, bool);
  ///@}

  ///@{
  /**
   * On: points at one place (within MergeTolerance, in coordinate units, 0 or more, default 0) are
   * one point of the surface, as STL files and split normals need. The output keeps the input's
   * points. Off (default): coincident boundary points are counted in a warning.
   */
  vtkSetMacro(MergeCoincidentPoints, bool);
  vtkGetMacro(MergeCoincidentPoints, bool);
  vtkBooleanMacro(MergeCoincidentPoints, bool);
  vtkSetMacro(MergeTolerance, double);
  vtkGetMacro(MergeTolerance, double);
  ///@}

  ///@{
  /**
   * How far apart points of different pieces may lie that are one point of the surface, in
   * coordinate units; 0: equal coordinates only; -1 (default): 1e-6 of the diagonal of the bounding
   * box, which single precision may lose. Not used with global point ids. 0 or more, or -1.
   */
  vtkSetMacro(SeamTolerance, double);
  vtkGetMacro(SeamTolerance, double);
  ///@}

  ///@{
  /**
   * The processes that hold pieces of the surface. Default: the global controller. Null, set
   * by SetController(): this process's surface is the whole one. Without that, where the pipeline
   * is asked for one of several pieces and there is no other process to join it with (no MPI, or no
   * controller of it), update is an error.
   */
  virtual void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  ///@{
  /**
   * Name of the result. Empty (default): the input array's name with the class's suffix. The
   * input array's own name: it is replaced.
   */
  vtkSetStdStringFromCharMacro(ResultArrayName);
  vtkGetCharFromStdStringMacro(ResultArrayName);
  ///@}

  enum OutputPrecisionType
  {
    OUTPUT_PRECISION_INPUT = 0,
    OUTPUT_PRECISION_SINGLE = 1,
    OUTPUT_PRECISION_DOUBLE = 2
  };

  ///@{
  /**
   * Type of the result; all arithmetic is in double. Input (default): unsigned char gives unsigned
   * char (rounded and clamped at the end, never between steps), float gives float, everything
   * else double.
   */
  vtkSetMacro(OutputPrecision, int);
  vtkGetMacro(OutputPrecision, int);
  void SetOutputPrecisionToInput() { this->SetOutputPrecision(OUTPUT_PRECISION_INPUT); }
  void SetOutputPrecisionToSingle() { this->SetOutputPrecision(OUTPUT_PRECISION_SINGLE); }
  void SetOutputPrecisionToDouble() { this->SetOutputPrecision(OUTPUT_PRECISION_DOUBLE); }
  const char* GetOutputPrecisionAsString();
  ///@}

  ///@{
  /**
   * With GenerateTimeSteps: MiB for states kept so that going back in time is cheap. 0 or more.
   * Default: 512.
   */
  vtkSetMacro(CheckpointMemoryLimit, int);
  vtkGetMacro(CheckpointMemoryLimit, int);
  ///@}

  /**
   * Set what the paper does: FirstOrder, IntrinsicDelaunay off, MaskMode Inpaint, HoldKnownValues
   * off, InitialFill Input, and what subclasses add. Units, times, weights and the solver stay.
   */
  virtual void UsePaperScheme();

  ///@{
  /**
   * Of the last update: the unit of time in coordinate and array units (exactly 1 in Absolute), h
   * and R of natural units, the sum of the solver's iterations, its largest relative residual, and
   * how many steps the filter has computed in its life, which tells what seeking costs.
   */
  vtkGetMacro(TimeUnit, double);
  vtkGetMacro(MeanEdgeLength, double);
  vtkGetMacro(ValueRange, double);
  vtkGetMacro(NumberOfIterations, vtkIdType);
  vtkGetMacro(Residual, double);
  vtkGetMacro(NumberOfStepsComputed, vtkIdType);
  ///@}

  vtkTypeBool ProcessRequest(
    vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

protected:
  vtkSurfaceDiffusionAlgorithm();
  ~vtkSurfaceDiffusionAlgorithm() override;

  /// What is wrong with properties and arrays, one sentence each.
  using Problems = std::vector<std::string>;

  /// Add a sentence for each property that has a value not allowed.
  virtual void CheckProperties(Problems& problems);

  /// Find and check the arrays of a block. False: the block has no data and passes through.
  virtual bool FindArrays(
    vtkPolyData* block, SurfaceDiffusion::BlockArrays& arrays, Problems& problems);

  /// Write everything of the class that a run's numbers depend on. Superclass first.
  virtual void WriteRunKey(std::ostream& key);

  /// Fill in what is missing in input.Data, before values are held and the model is made.
  virtual void PrepareData(SurfaceDiffusion::ModelInput& input);

  /// Make the model. `steps` is how many are planned.
  virtual std::unique_ptr<SurfaceDiffusion::Model> MakeModel(
    SurfaceDiffusion::ModelInput& input, int steps) = 0;

  /// Work on the current state of run.Path that may take long or fail. It comes before anything is
  /// written to any block.
  virtual void PrepareResult(
    const SurfaceDiffusion::SurfaceRun&, const SurfaceDiffusion::ProgressMonitor&)
  {
  }

  /// Add the result, the current state of run.Path, to the output block.
  virtual void WriteResult(const SurfaceDiffusion::SurfaceRun& run,
    const SurfaceDiffusion::BlockArrays& arrays, vtkPolyData* output);

  /// Whether the model can be solved by processes that have a piece each, with these settings and,
  /// as far as this process can tell, on these pieces.
  virtual bool CanBeDistributed(const std::vector<SurfaceDiffusion::SurfacePiece>&)
  {
    return false;
  }

  /// Visit the read-only properties, which all processes are to have alike. Superclass first.
  virtual void VisitReported(const std::function<void(double&)>& visit);

  /// Helpers of WriteResult().
  std::string FindResultName(const SurfaceDiffusion::BlockArrays& arrays);
  int FindResultType(const SurfaceDiffusion::BlockArrays& arrays);

  /// What is added to the input array's name.
  virtual const char* GetResultSuffix() = 0;

  /// The natural unit of time, and the energy's dimension, as powers of length and value.
  struct Dimension
  {
    double Length, Value;
  };
  virtual Dimension GetTimeDimension() = 0;
  virtual Dimension GetEnergyDimension() = 0;
  /// What the natural unit of time is multiplied by beyond its dimension.
  virtual double GetTimeFactor() { return 1.0; }
  /// Whether the history has a column Clamped.
  virtual bool CountsClamped() { return false; }

  /// Steps that a run has, and the time between them in units of TimeStep.
  virtual int GetEffectiveNumberOfTimeSteps() { return this->NumberOfTimeSteps; }
  virtual double GetEffectiveTimeStep() { return this->TimeStep; }
  /// Whether the data pull the result: a positive or automatic lambda.
  virtual bool UsesFidelity() { return this->FidelityWeight > 0.0; }
  /// Whether times are in absolute units whatever Units says.
  virtual bool GetTimeIsAbsolute() { return this->Units == UNITS_ABSOLUTE; }
  /// Whether values are measured in R in natural units; R is 1 otherwise.
  virtual bool HasValueRange() { return true; }

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  virtual int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*);

  /// A helper of CheckProperties(): the sentence where `holds` is false.
  static void Require(
    bool holds, const char* property, double value, const char* allowed, Problems& problems);

  double TimeStep = 1.0;
  int NumberOfTimeSteps = 10;
  int Units = UNITS_NATURAL;
  bool GenerateTimeSteps = false;
  int OutputInterval = 1;
  double FidelityWeight = 0.0;
  int MaskMode = MASK_MODE_INPAINT;
  int InitialFill = INITIAL_FILL_MEAN;
  bool HoldKnownValues = false;
  int RandomSeed = 0;
  double AlongDiffusivity = 1.0;
  double AcrossDiffusivity = 1.0;
  int TimeIntegrator = TIME_INTEGRATOR_FIRST_ORDER;
  int Solver = SOLVER_AUTOMATIC;
  double Tolerance = 1e-10;
  int MaximumNumberOfIterations = 1000;
  bool IntrinsicDelaunay = false;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;
  double SeamTolerance = -1.0;
  std::string ResultArrayName;
  int OutputPrecision = OUTPUT_PRECISION_INPUT;
  int CheckpointMemoryLimit = 512;

private:
  vtkSurfaceDiffusionAlgorithm(const vtkSurfaceDiffusionAlgorithm&) = delete;
  void operator=(const vtkSurfaceDiffusionAlgorithm&) = delete;

  class Execution; // one RequestData
  friend class Execution;

  /// RequestData for surfaces each of which is here, in one piece.
  void Execute(const std::vector<SurfaceDiffusion::SurfacePiece>& surfaces,
    const SurfaceDiffusion::Processes* processes, vtkInformation* request,
    vtkInformationVector* outputs);
  /// Whether each process works on its piece: these are one surface, and it is worth while.
  bool Distributes(const SurfaceDiffusion::Processes& processes,
    const std::vector<SurfaceDiffusion::SurfacePiece>& pieces);
  int TakeTime(vtkInformation* request, vtkInformationVector* outputs);
  void ShareReported();

  /// Step of the run that is published last at or before a time.
  int StepAtTime(double time);
  std::vector<double> PublishedTimes();

  std::vector<std::unique_ptr<SurfaceDiffusion::SurfaceRun>> Runs; ///< one per block
  std::unique_ptr<SurfaceDiffusion::GatheredSurfaces> Gathered; ///< of surfaces in pieces
  vtkMultiProcessController* Controller = nullptr;
  bool HasWholeSurface = false; ///< as null for Controller says
  double TimeUnit = 1.0;
  double MeanEdgeLength = 0.0;
  double ValueRange = 0.0;
  vtkIdType NumberOfIterations = 0;
  double Residual = 0.0;
  vtkIdType NumberOfStepsComputed = 0;
};

#endif
