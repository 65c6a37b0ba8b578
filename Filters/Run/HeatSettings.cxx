// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/HeatSettings.h"

#include "Core/Models/LinearDiffusion.h"
#include "Core/Models/TikhonovDeblurring.h"
#include "Core/Statistics/NoiseLevel.h"
#include "Run/Angles.h"
#include "Run/DataPreparation.h"
#include "Run/FidelitySearch.h"
#include "Run/ModelInputs.h"
#include "Run/Rewording.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Of columns with matrices of their own.
constexpr std::size_t MostFactors = 32;

LinearDiffusion::Scheme SchemeOf(TimeIntegrator integrator, bool hasWidth)
{
  switch (integrator)
  {
    case TimeIntegrator::Automatic:
      return hasWidth ? LinearDiffusion::Scheme::Exponential : LinearDiffusion::Scheme::SDIRK2;
    case TimeIntegrator::Exponential:
      return LinearDiffusion::Scheme::Exponential;
    case TimeIntegrator::SecondOrder:
      return LinearDiffusion::Scheme::SDIRK2;
    default:
      return LinearDiffusion::Scheme::BackwardEuler;
  }
}

/// Ten steps with residuals of 1e-6 change values by up to 1e-5 of their range (measured), and by
/// more where triangles are small: share is the root of the smallest control area over that of an
/// even mesh.
void TightenSteps(IterationLimits& limits, double share)
{
  const double asked = std::max(limits.Tolerance, limits.AskedTolerance);
  limits.AskedTolerance = asked;
  limits.Tolerance = std::max(0.1 * share * asked, std::min(asked, 1e-10));
}

double ShareOfSmallTriangles(const TriangleMesh& mesh, double h, const ParallelFor& parallel)
{
  const Vector& areas = mesh.ControlAreas();
  double opposite =
    Max(parallel, mesh.NumberOfVertices(), [&](Index i) { return 1.0 - areas[i] / (0.5 * h * h); });
  mesh.GetReduction().Max(&opposite, 1);
  return std::sqrt(std::min(std::max(1.0 - opposite, 0.0), 1.0));
}

} // namespace

void HeatSettings::Visit(SettingVisitor& visitor)
{
  Rewording reworded(visitor,
    { { "TimeIntegrator",
        { "", "The time integrator. Automatic: Exponential with FWHM, SecondOrder otherwise." } },
      { "Tolerance",
        { "",
          "The error that an iterative solver may leave in about ten steps, as a part of the range "
          "of the data, between 0 and 1. It stops at a relative residual of a tenth of it, or less "
          "where triangles are much smaller than on average." } } });
  this->DataSettings::Visit(reworded);
  VisitTimeIntegrator(reworded, this->TimeIntegrator, { true, true, false, true, true });
  visitor.Choice({ "MassMatrix", "",
                   "The mass matrix. Lumped: the paper's; widths below five mean edge lengths fall "
                   "short. Mixed: the mean of that and of the consistent one, with which the blur "
                   "has the width of FWHM from 2 mean edge lengths on. Automatic: Mixed with FWHM, "
                   "Lumped otherwise." },
    this->MassMatrix, { "Automatic", "Lumped", "Mixed" });
  visitor.Choice(
    { "Mode", "",
      "TimeSteps: NumberOfTimeSteps steps of TimeStep. SteadyState: the limit for "
      "infinite time, in one solve. It is the harmonic function of the fixed or "
      "held values, the minimiser of the energy if there is a fidelity term, and "
      "otherwise the mean of each connected component.",
      "(BlurFWHM=0 and (FWHM=0 or Mode=SteadyState)) or (BlurFWHM!=0 and Mode=TimeSteps)" },
    this->Mode, { "TimeSteps", "SteadyState" });
  visitor.Number({ "FWHM", "coordinates",
                   "Full width at half maximum of the blur, in the unit of the coordinates. It "
                   "replaces TimeStep, and times are then in that unit squared. It requires "
                   "diffusivities of 1 and no fidelity term. 0: off.",
                   "(Mode=TimeSteps and AutomaticFidelity=0 and FidelityWeight=0 and "
                   "AlongDiffusivity=1 and AcrossDiffusivity=1) or FWHM!=0" },
    this->FWHM, SettingRange::NonNegative());
  VisitAutomaticFidelity(
    visitor, this->AutomaticFidelity, this->NoiseLevel, "FWHM=0 or AutomaticFidelity=1");
  VisitPeriod(visitor, this->Period);
  this->Vectors.Visit(visitor);
  this->Blur.Visit(visitor);
}

void HeatSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->DataSettings::CheckTogether(fields, problems);
  if (this->Blur.IsOn())
  {
    RequireChoice("Mode", this->Mode, HeatMode::SteadyState, "SteadyState",
      Word::Setting("BlurFWHM"), problems);
    Require(this->Vectors.Type != VectorType::Tangent, Word::Setting("VectorType"),
      Word::Number("VectorType", this->Vectors.Type),
      Sentence(Word::NumberedChoice("VectorType", VectorType::Components, "Components"))
        << " together with " << Word::Setting("BlurFWHM"),
      problems);
  }
  if (this->Period > 0.0 && this->Vectors.Type == VectorType::Tangent)
  {
    problems.push_back(Sentence(Word::Setting("Period"))
      << " is " << this->Period << "; allowed together with " << Word::Setting("VectorType") << " "
      << Word::Choice("VectorType", VectorType::Tangent, "Tangent") << ": 0");
  }
  this->Vectors.CheckTogether(
    fields, *this, this->AlongDiffusivity != 1.0 || this->AcrossDiffusivity != 1.0, problems);
  if (!(this->FWHM > 0.0))
  {
    return;
  }
  Sentence width(" together with ");
  width << Word::Setting("FWHM") << ", whose width it would change";
  Require(this->FidelityWeight == 0.0, Word::Setting("FidelityWeight"), this->FidelityWeight,
    Sentence("0") << width, problems);
  Require(!this->AutomaticFidelity, Word::Setting("AutomaticFidelity"), Word::SwitchNumber(true),
    Sentence(Word::SwitchNumber(false)) << width, problems);
  Require(this->AlongDiffusivity == 1.0, Word::Setting("AlongDiffusivity"), this->AlongDiffusivity,
    Sentence("1") << width, problems);
  Require(this->AcrossDiffusivity == 1.0, Word::Setting("AcrossDiffusivity"),
    this->AcrossDiffusivity, Sentence("1") << width, problems);
  RequireChoice("Mode", this->Mode, HeatMode::TimeSteps, "TimeSteps",
    Sentence(Word::Setting("FWHM")) << ": a steady state has no width", problems);
}

ModelTraits HeatSettings::DescribeModel() const
{
  ModelTraits traits = this->DescribeSteps(this->Mode == HeatMode::SteadyState);
  if (this->FWHM > 0.0)
  {
    traits.TimeStep =
      this->FWHM * this->FWHM / (16.0 * std::log(2.0)) / std::max(1, this->NumberOfTimeSteps);
    traits.AbsoluteTime = true;
  }
  if (traits.IsSteady)
  {
    traits.Limits = WithoutInertia(traits.Limits);
  }
  else
  {
    TightenSteps(traits.Limits, 1.0);
  }
  traits.Time = { 2.0, 0.0 };
  traits.ResultSuffix = "Diffused";
  traits.Energy = { 0.0, 2.0 };
  traits.UsesFidelity = this->FindsFidelity() || this->FidelityWeight > 0.0;
  traits.EstimatesNoise = this->FindsFidelity();
  traits.ColumnsAreIndependent =
    this->InitialFill != SurfaceDiffusion::InitialFill::Noise && this->Period == 0.0;
  traits.Period = this->Period;
  traits.Vectors =
    this->Blur.IsOn() || this->Period > 0.0 ? VectorType::Components : this->Vectors.Type;
  traits.DropsNormalPart = this->Vectors.NormalPart == NormalPart::Drop;
  traits.CanBeDistributed =
    !this->FindsFidelity() && !this->Blur.IsOn() && traits.Vectors != VectorType::Tangent;
  DescribeData(*this, traits);
  return traits;
}

std::vector<Output> HeatSettings::Finish(const RunState& state, RunResult& result) const
{
  std::vector<Output> outputs = this->DataSettings::Finish(state, result);
  if (this->Period > 0.0)
  {
    Output coherence{ "Coherence", Place::PerVertex, OutputType::Real,
      CoherenceOfAngles(state.Path.State() * state.Units.ValueUnit) };
    coherence.IsBesideResult = true;
    outputs.push_back(std::move(coherence));
  }
  return outputs;
}

/// A width in another unit than the coordinates shows as one that the mesh does not resolve, or that
/// is larger than the surface.
void HeatSettings::WarnOfWidth(const ModelInputs& inputs, RunResult& result) const
{
  if (!(this->FWHM > 0.0))
  {
    return;
  }
  constexpr int fewest = 4; // 1.5 % off for white noise, and 6 % with one less
  const LinearDiffusion::Scheme scheme = SchemeOf(this->TimeIntegrator, true);
  if (scheme != LinearDiffusion::Scheme::Exponential && this->NumberOfTimeSteps > 0 &&
    this->NumberOfTimeSteps < fewest)
  {
    const bool first = this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::FirstOrder;
    result.WarnOnce(Sentence(Word::Setting("NumberOfTimeSteps"))
      << " is " << this->NumberOfTimeSteps << ", in which "
      << Word::Choice("TimeIntegrator", this->TimeIntegrator, first ? "FirstOrder" : "SecondOrder")
      << " misses the blur of " << Word::Setting("FWHM") << " by more than 5 % (allow more steps, "
      << "or set " << Word::Setting("TimeIntegrator") << " to "
      << Word::Choice(
           "TimeIntegrator", SurfaceDiffusion::TimeIntegrator::Exponential, "Exponential")
      << ")");
  }
  constexpr double unresolved = 0.1; // changes waves of two edges by a hundredth
  constexpr double narrow = 1.5; // white noise is off by up to a tenth
  constexpr double flat = 2.0; // leaves a thousandth of the longest waves of a sphere
  const double h = inputs.Units.MeanEdgeLength;
  const double diagonal = DiagonalOf(inputs.Surface.Points(), inputs.Processes);
  double edges = inputs.Surface.InputMesh().NumberOfEdges();
  inputs.Processes.Sum(&edges, 1);
  Sentence text(Word::Setting("FWHM"));
  text << " is " << this->FWHM;
  if (edges > 0.0 && this->FWHM < unresolved * h)
  {
    result.WarnOnce(text << ", far below the mean edge length, " << h
                         << ", and values hardly change where edges are so long (its unit is that "
                            "of the coordinates)");
  }
  else if (edges > 0.0 && this->FWHM < narrow * h)
  {
    result.WarnOnce(text << ", below " << narrow << " mean edge lengths of " << h
                         << ", and noise gets another width (refine the surface, or smooth to the "
                            "width of the noise: smooth_to_fwhm(), --to-fwhm of the command)");
  }
  else if (edges > 0.0 && this->FWHM > flat * diagonal)
  {
    result.WarnOnce(text << ", but the surface is " << diagonal
                         << " large: little but the mean is left (its unit is that of the "
                            "coordinates)");
  }
}

/// TikhonovDeblurring: the steady state with a blur.
std::unique_ptr<Model> HeatSettings::MakeDeblurring(ModelInputs& inputs, RunResult& result) const
{
  const CornerWeights weights = MakeWeights(*this, inputs);
  UnitSystem units = inputs.Units;
  units.Natural = !this->IsAbsolute();
  const double unit = units.ToCore(1.0, -2.0, 0.0);
  const double h = inputs.Units.CoreEdgeLength();
  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.NumberOfColumns = static_cast<int>(inputs.Columns);
  task.Anisotropy = this->Anisotropy();
  task.IsPreconditioner = true;
  std::shared_ptr<DeblurringSpace> space; // all weights find the data's minimiser in it
  if (!this->IsDirected())
  {
    space = std::make_shared<DeblurringSpace>();
    space->Diffusivity = this->AlongDiffusivity;
  }
  const auto make = [&](PointData data, double fidelity) -> std::unique_ptr<Model>
  {
    task.DiffusionNumber = this->LargestDiffusivity() / (fidelity * h * h);
    const auto solver = inputs.Solvers.Find(SolverPurpose::Step, task);
    const IterationLimits limits = solver->GetLimits();
    return std::make_unique<TikhonovDeblurring>(inputs.Surface.SharedAssembler(), weights,
      std::move(data), fidelity, this->Blur.Make(inputs, limits), solver, limits, inputs.Parallel,
      space);
  };
  this->Blur.Warn(inputs, result);
  FidelityWeights found{ { this->FidelityWeight * unit } };
  if (this->FindsFidelity())
  {
    const auto blur = this->Blur.Make(inputs, {});
    FidelityTask search;
    search.NoiseLevel = this->NoiseLevel;
    search.ColumnsShareWeight = false;
    search.IsLinear = true;
    search.Blur = blur.get();
    found = FindFidelity(inputs, search, make, result);
  }
  result.AddNumber("EffectiveFidelityWeight", found.OfColumns.front() / unit);
  return found.MakeModels(std::move(inputs.Data), make);
}

HeatSettings::Maker HeatSettings::DiffusionMaker(const ModelInputs& inputs,
  std::shared_ptr<const TangentPlanes> planes, CornerWeights weights, const SolverTask& task) const
{
  const auto assembler = inputs.Surface.SharedAssembler();
  if (!planes)
  {
    return [&inputs, assembler, weights](PointData data, const LinearDiffusion::Settings& settings,
             std::shared_ptr<LinearSolver> solver)
    {
      return std::make_unique<LinearDiffusion>(
        assembler, weights, std::move(data), settings, std::move(solver), inputs.Parallel);
    };
  }
  return [&inputs, assembler, weights, task, planes, vectors = this->Vectors](PointData data,
           const LinearDiffusion::Settings& settings, std::shared_ptr<LinearSolver> solver)
  {
    std::unique_ptr<Model> normal;
    if (vectors.NormalPart == NormalPart::Diffuse)
    {
      PointData parts = data;
      parts.Given = planes->NormalParts(data.Given);
      parts.Start = planes->NormalParts(data.Start);
      SolverTask scalar = task;
      scalar.NumberOfVertices = assembler->Mesh().NumberOfVertices();
      const auto solverOfNormal = inputs.Solvers.Find(SolverPurpose::NormalPart, scalar);
      solverOfNormal->SetLimits(solver->GetLimits());
      normal = std::make_unique<LinearDiffusion>(
        assembler, weights, std::move(parts), settings, solverOfNormal, inputs.Parallel);
    }
    return std::make_unique<TangentDiffusion>(assembler, planes, weights, std::move(data),
      TangentDiffusion::Settings{ settings, vectors.Laplacian, vectors.NormalPart },
      std::move(solver), std::move(normal), inputs.Parallel);
  };
}

std::unique_ptr<Model> HeatSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  if (this->Blur.IsOn())
  {
    return this->MakeDeblurring(inputs, result);
  }
  this->WarnOfWidth(inputs, result);
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const bool isPlain = !this->IsDirected() && this->AlongDiffusivity == 1.0;
  const CornerWeights weights = isPlain ? CornerWeights() : MakeWeights(*this, inputs);
  const ModelTraits traits = this->DescribeModel();

  UnitSystem timeUnits = inputs.Units;
  timeUnits.Natural = !traits.AbsoluteTime;
  const double fidelityUnit = timeUnits.ToCore(1.0, -2.0, 0.0);
  LinearDiffusion::Settings settings;
  settings.TimeStep = timeUnits.ToCore(traits.TimeStep, traits.Time);
  settings.Fidelity = this->FidelityWeight * fidelityUnit;
  settings.TimeScheme = SchemeOf(this->TimeIntegrator, this->FWHM > 0.0);
  settings.HasMixedMass = this->MassMatrix == SurfaceDiffusion::MassMatrix::Mixed ||
    (this->MassMatrix == SurfaceDiffusion::MassMatrix::Automatic && this->FWHM > 0.0);

  const double h = inputs.Units.CoreEdgeLength();
  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.NumberOfColumns = static_cast<int>(inputs.Columns);
  task.DiffusionNumber = this->LargestDiffusivity() * settings.ImplicitStep() / (h * h);
  task.Anisotropy = this->Anisotropy();
  if (inputs.AreTangent)
  {
    task.NumberOfVertices *= 2; // unknowns
    task.NumberOfColumns = std::max(1, task.NumberOfColumns / 3);
    task.AllowMultigrid = false;
  }
  const auto planes = inputs.AreTangent
    ? std::make_shared<TangentPlanes>(
        inputs.Surface.SharedMesh(), VertexPositions(inputs.Surface), inputs.Parallel)
    : nullptr;
  const auto makeDiffusion = this->DiffusionMaker(inputs, planes, weights, task);
  const double solvesPerStep = settings.NumberOfSolves();
  if (this->Mode == HeatMode::SteadyState)
  {
    settings.TimeScheme = LinearDiffusion::Scheme::SteadyState;
    task.DiffusionNumber.reset();
  }

  FidelityWeights fidelity{ { settings.Fidelity } };
  double effective = this->FidelityWeight;
  if (this->AutomaticFidelity)
  {
    const auto solver = inputs.Solvers.Find(SolverPurpose::Search, task, solvesPerStep);
    const auto solve = [&](PointData data, double weight)
    {
      LinearDiffusion::Settings steady;
      steady.Fidelity = weight;
      steady.TimeScheme = LinearDiffusion::Scheme::SteadyState;
      return makeDiffusion(std::move(data), steady, solver);
    };
    FidelityTask search;
    search.NoiseLevel = this->NoiseLevel;
    search.ColumnsShareWeight = inputs.AreTangent || this->Period > 0.0;
    search.IsLinear = true;
    search.Planes = this->Vectors.NormalPart == NormalPart::Diffuse ? nullptr : planes.get();
    fidelity = FindFidelity(inputs, search, solve, result);
    effective = fidelity.OfColumns.front() / fidelityUnit;
  }
  result.AddNumber("EffectiveFidelityWeight", effective);
  const double smallest = ShareOfSmallTriangles(mesh, h, inputs.Parallel);
  // Columns with weights of their own would need the memory for a factor each. With one solver, each
  // step factorises the matrices of all of them again.
  settings.SharesSolver = fidelity.OfColumns.size() >
    (this->Mode == HeatMode::SteadyState ? std::size_t{ 1 } : MostFactors);
  std::shared_ptr<LinearSolver> solver;
  const auto make = [&](PointData data, double weight)
  {
    if (solver && !settings.SharesSolver) // that of the former column
    {
      inputs.Solvers.Release(SolverPurpose::Step);
    }
    solver = inputs.Solvers.Find(SolverPurpose::Step, task, solvesPerStep);
    settings.Fidelity = weight;
    if (this->Mode == HeatMode::TimeSteps)
    {
      IterationLimits limits = solver->GetLimits();
      TightenSteps(limits, smallest);
      solver->SetLimits(limits);
      settings.SufficientResidual = limits.AskedTolerance;
    }
    return makeDiffusion(std::move(data), settings, solver);
  };
  return fidelity.MakeModels(std::move(inputs.Data), make);
}

} // namespace SurfaceDiffusion
