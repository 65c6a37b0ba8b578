// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntrinsicTVFilter.h"

#include "Conversion/EnumText.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SurfaceRun.h"
#include "Core/Models/CrouzeixRaviart.h"
#include "Core/Models/NoiseLevel.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/TotalVariationFlow.h"
#include "Distributed/PiecePartition.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkIntrinsicTVFilter);

namespace
{

/// Where L1 fidelity of FirstOrder is rounded, in R.
constexpr double RoundingOfL1 = 1e-3;

/// Of the minimisers that the search for lambda tries.
constexpr double SearchTolerance = 1e-3;

/// Where the diffusivity of nonlinear models is judged, in R/h.
constexpr double TypicalGradient = 0.01;

} // namespace

vtkIntrinsicTVFilter::vtkIntrinsicTVFilter()
{
  this->FidelityWeight = 3.0;
  this->Tolerance = 1e-3;
}

const char* vtkIntrinsicTVFilter::GetModeAsString()
{
  return EnumText(this->Mode, { "TimeSteps", "SteadyState" });
}

const char* vtkIntrinsicTVFilter::GetEdgeFunctionAsString()
{
  return EnumText(this->EdgeFunction,
    { "TotalVariation", "PeronaMalikExponential", "PeronaMalikRational", "Charbonnier", "Weickert",
      "Constant" });
}

const char* vtkIntrinsicTVFilter::GetAcrossEdgeFunctionAsString()
{
  return EnumText(this->AcrossEdgeFunction,
    { "Same", "TotalVariation", "PeronaMalikExponential", "PeronaMalikRational", "Charbonnier",
      "Weickert", "Constant" });
}

const char* vtkIntrinsicTVFilter::GetChannelCouplingAsString()
{
  return EnumText(this->ChannelCoupling, { "PerChannel", "Joint" });
}

const char* vtkIntrinsicTVFilter::GetFidelityNormAsString()
{
  return EnumText(this->FidelityNorm, { "L2", "L1" });
}

const char* vtkIntrinsicTVFilter::GetDiscretizationAsString()
{
  return EnumText(this->Discretization, { "Linear", "CrouzeixRaviart" });
}

void vtkIntrinsicTVFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
  this->SetEdgeFunctionToTotalVariation();
  this->SetAcrossEdgeFunctionToSame();
  this->SetChannelCouplingToPerChannel();
  this->SetFidelityNormToL2();
  this->SetAutomaticFidelity(false);
  this->SetDiscretizationToLinear();
}

//------------------------------------------------------------------------------------------------
void vtkIntrinsicTVFilter::CheckProperties(Problems& problems)
{
  this->Superclass::CheckProperties(problems);
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  const auto oneOf = [](int value, int count) { return value >= 0 && value < count; };
  const char* const edgeFunctions = "0 TotalVariation, 1 PeronaMalikExponential, 2 "
                                    "PeronaMalikRational, 3 Charbonnier, 4 Weickert, 5 Constant";
  const char* const acrossEdgeFunctions =
    "0 Same, 1 TotalVariation, 2 PeronaMalikExponential, 3 PeronaMalikRational, 4 Charbonnier, 5 "
    "Weickert, 6 Constant";
  Require(oneOf(this->Mode, 2), "Mode", this->Mode, "0 TimeSteps, 1 SteadyState", problems);
  Require(
    oneOf(this->EdgeFunction, 6), "EdgeFunction", this->EdgeFunction, edgeFunctions, problems);
  Require(oneOf(this->AcrossEdgeFunction, 7), "AcrossEdgeFunction", this->AcrossEdgeFunction,
    acrossEdgeFunctions, problems);
  Require(positive(this->Beta), "Beta", this->Beta, "finite numbers above 0", problems);
  Require(positive(this->EdgeThreshold), "EdgeThreshold", this->EdgeThreshold,
    "finite numbers above 0", problems);
  Require(oneOf(this->ChannelCoupling, 2), "ChannelCoupling", this->ChannelCoupling,
    "0 PerChannel, 1 Joint", problems);
  Require(oneOf(this->FidelityNorm, 2), "FidelityNorm", this->FidelityNorm, "0 L2, 1 L1", problems);
  Require(std::isfinite(this->NoiseLevel) && this->NoiseLevel >= 0.0, "NoiseLevel",
    this->NoiseLevel, "finite numbers, 0 or more", problems);
  Require(oneOf(this->Discretization, 2), "Discretization", this->Discretization,
    "0 Linear, 1 CrouzeixRaviart", problems);
  Require(this->StopTolerance > 0.0 && this->StopTolerance < 1.0, "StopTolerance",
    this->StopTolerance, "numbers between 0 and 1, ends excluded", problems);
  Require(this->TimeIntegrator == TIME_INTEGRATOR_FIRST_ORDER ||
      this->TimeIntegrator == TIME_INTEGRATOR_IMPLICIT,
    "TimeIntegrator", this->TimeIntegrator, "0 FirstOrder, 2 Implicit", problems);

  if (this->Mode == MODE_STEADY_STATE)
  {
    this->RequireConvexEnergy("Mode SteadyState", problems);
  }
  else if (this->TimeIntegrator == TIME_INTEGRATOR_IMPLICIT)
  {
    this->RequireConvexEnergy("TimeIntegrator Implicit", problems);
  }
  if (this->AutomaticFidelity)
  {
    this->RequireConvexEnergy("AutomaticFidelity", problems);
    Require(this->FidelityNorm != FIDELITY_NORM_L1, "FidelityNorm", this->FidelityNorm,
      "0 L2 together with AutomaticFidelity", problems);
  }
}

void vtkIntrinsicTVFilter::RequireConvexEnergy(const char* purpose, Problems& problems)
{
  const std::string with = std::string(" together with ") + purpose;
  const bool convex = this->EdgeFunction != EDGE_FUNCTION_PERONA_MALIK_EXPONENTIAL &&
    this->EdgeFunction != EDGE_FUNCTION_PERONA_MALIK_RATIONAL &&
    this->EdgeFunction != EDGE_FUNCTION_WEICKERT;
  Require(convex, "EdgeFunction", this->EdgeFunction,
    ("0 TotalVariation, 3 Charbonnier, 5 Constant" + with).c_str(), problems);
  Require(this->AcrossEdgeFunction == ACROSS_EDGE_FUNCTION_SAME, "AcrossEdgeFunction",
    this->AcrossEdgeFunction, ("0 Same" + with).c_str(), problems);
  Require(this->AlongDiffusivity > 0.0 || this->AcrossDiffusivity > 0.0,
    "AlongDiffusivity and AcrossDiffusivity", 0.0, ("one above 0" + with).c_str(), problems);
}

bool vtkIntrinsicTVFilter::FindArrays(vtkPolyData* block, BlockArrays& arrays, Problems& problems)
{
  const bool hasData = this->Superclass::FindArrays(block, arrays, problems);
  if (!arrays.Direction && this->AcrossEdgeFunction != ACROSS_EDGE_FUNCTION_SAME)
  {
    std::ostringstream text;
    text << "AcrossEdgeFunction is " << this->AcrossEdgeFunction
         << " but DirectionArray is not set; allowed: 0 Same, or an array of directions";
    problems.push_back(text.str());
  }
  return hasData;
}

void vtkIntrinsicTVFilter::WriteRunKey(std::ostream& key)
{
  this->Superclass::WriteRunKey(key);
  key << this->Mode << ' ' << this->EdgeFunction << ' ' << this->AcrossEdgeFunction << ' '
      << this->Beta << ' ' << this->EdgeThreshold << ' ' << this->ChannelCoupling << ' '
      << this->FidelityNorm << ' ' << this->AutomaticFidelity << ' ' << this->NoiseLevel << ' '
      << this->Discretization << ' ' << this->StopTolerance << ' ';
}

vtkIntrinsicTVFilter::Dimension vtkIntrinsicTVFilter::GetTimeDimension()
{
  return this->EdgeFunction == EDGE_FUNCTION_TOTAL_VARIATION ? Dimension{ 1.0, 1.0 }
                                                             : Dimension{ 2.0, 0.0 };
}

vtkIntrinsicTVFilter::Dimension vtkIntrinsicTVFilter::GetEnergyDimension()
{
  return this->EdgeFunction == EDGE_FUNCTION_TOTAL_VARIATION ? Dimension{ 1.0, 1.0 }
                                                             : Dimension{ 0.0, 2.0 };
}

int vtkIntrinsicTVFilter::GetEffectiveNumberOfTimeSteps()
{
  return this->Mode == MODE_STEADY_STATE ? 1 : this->NumberOfTimeSteps;
}

bool vtkIntrinsicTVFilter::Minimizes() const
{
  return this->Mode == MODE_STEADY_STATE || this->TimeIntegrator == TIME_INTEGRATOR_IMPLICIT;
}

bool vtkIntrinsicTVFilter::UsesFidelity()
{
  return this->AutomaticFidelity || this->Superclass::UsesFidelity();
}

//------------------------------------------------------------------------------------------------
/// Makes models of the core from the filter's properties.
class vtkIntrinsicTVFilter::ModelMaker
{
public:
  ModelMaker(const vtkIntrinsicTVFilter& filter, ModelInput& input, const Dimension& time)
    : Filter(filter)
    , Input(input)
    , Units(input.Units)
    , Time(time)
  {
  }

  /// One of FidelityWeight in the core's units.
  double FidelityUnit() const
  {
    const double ofL1 = this->Filter.FidelityNorm == FIDELITY_NORM_L1 ? 1.0 : 0.0;
    return this->Units.ToCore(1.0, -this->Time.Length, ofL1 - this->Time.Value);
  }

  /// The lambda of AutomaticFidelity, in the core's units.
  double FindFidelity() const
  {
    const PointData& data = this->Input.Data;
    const double noise = this->Filter.NoiseLevel > 0.0
      ? this->Filter.NoiseLevel / this->Units.ValueUnit
      : EstimateNoiseLevel(*this->Input.Surface.Operators, data);
    const auto discrepancy = [&](double fidelity)
    {
      const auto model =
        this->MakeMinimizing(this->Input.Surface.Operators, data, fidelity, true, SearchTolerance);
      model->Advance(this->Input.Monitor.Part(0.5, 0.5));
      return Discrepancy(*this->Input.Surface.Mesh, data, model->State());
    };
    const double h = this->MeanEdgeLength();
    const double start = this->IsTotalVariation(this->Filter.EdgeFunction)
      ? 1.0 / (h * this->ValueRange())
      : 1.0 / (h * h);
    return FindFidelityByDiscrepancy(discrepancy, noise, start);
  }

  /// The model that the properties ask for, on the mesh of the operators.
  std::unique_ptr<Model> Make(
    std::shared_ptr<const Assembler> operators, PointData data, double fidelity) const
  {
    return this->Filter.Minimizes()
      ? this->MakeMinimizing(std::move(operators), std::move(data), fidelity,
          this->Filter.Mode == MODE_STEADY_STATE, this->Filter.StopTolerance)
      : this->MakeLagged(std::move(operators), std::move(data), fidelity);
  }

private:
  std::unique_ptr<Model> MakeMinimizing(std::shared_ptr<const Assembler> operators, PointData data,
    double fidelity, bool steady, double tolerance) const
  {
    TotalVariationFlow::Settings settings;
    settings.SteadyState = steady;
    settings.TimeStep = this->TimeStep();
    settings.Fidelity = fidelity;
    settings.Function = this->MakeEdgeFunction(this->Filter.EdgeFunction);
    settings.AlongDiffusivity = this->Filter.AlongDiffusivity;
    settings.AcrossDiffusivity = this->Filter.AcrossDiffusivity;
    settings.Coupling = this->Coupling();
    settings.Norm = this->Norm();
    settings.StopTolerance = tolerance;
    return std::make_unique<TotalVariationFlow>(
      std::move(operators), this->Frames(), std::move(data), settings, this->Input.Parallel);
  }

  std::unique_ptr<Model> MakeLagged(
    std::shared_ptr<const Assembler> operators, PointData data, double fidelity) const
  {
    NonlinearDiffusion::Settings settings;
    settings.TimeStep = this->TimeStep();
    settings.Fidelity = fidelity;
    settings.Along = this->MakeEdgeFunction(this->Filter.EdgeFunction);
    settings.Across = settings.Along;
    settings.AlongDiffusivity = this->Filter.AlongDiffusivity;
    settings.AcrossDiffusivity = this->Filter.AcrossDiffusivity;
    if (this->Filter.AcrossEdgeFunction != ACROSS_EDGE_FUNCTION_SAME)
    {
      const int across = this->Filter.AcrossEdgeFunction - 1;
      settings.Across = this->MakeEdgeFunction(across);
      // In natural units g2 is a formula in x/h and u/R, whatever the dimension of time is.
      const double power = (this->IsTotalVariation(this->Filter.EdgeFunction) ? 1.0 : 0.0) -
        (this->IsTotalVariation(across) ? 1.0 : 0.0);
      settings.AcrossDiffusivity *= this->Units.ToCore(1.0, power, -power);
    }
    settings.Coupling = this->Coupling();
    settings.Norm = this->Norm();
    settings.FidelityRounding = RoundingOfL1 * this->ValueRange();

    const double h = this->MeanEdgeLength();
    const double gradient = TypicalGradient * this->ValueRange() / h;
    const double along = settings.AlongDiffusivity * settings.Along(gradient * gradient);
    const double across = settings.AcrossDiffusivity * settings.Across(gradient * gradient);
    SolverTask task;
    task.NumberOfVertices = operators->Mesh().NumberOfVertices();
    task.AllowMultigrid = false;
    task.DiffusionNumber = settings.TimeStep * std::max(along, across) / (h * h);
    return std::make_unique<NonlinearDiffusion>(std::move(operators), this->Frames(),
      std::move(data), settings, this->Input.Solver("diffusion", task), this->Input.Parallel);
  }

  SurfaceDiffusion::EdgeFunction MakeEdgeFunction(int kind) const
  {
    SurfaceDiffusion::EdgeFunction function;
    function.Kind = static_cast<EdgeFunctionKind>(kind);
    function.Beta = this->Units.ToCore(this->Filter.Beta, -2.0, 2.0);
    function.Threshold = this->Units.ToCore(this->Filter.EdgeThreshold, -1.0, 1.0);
    return function;
  }

  /// e1 where g1 and g2 differ, no row otherwise.
  TangentVectors Frames() const
  {
    const bool directed = this->Filter.AlongDiffusivity != this->Filter.AcrossDiffusivity ||
      this->Filter.AcrossEdgeFunction != ACROSS_EDGE_FUNCTION_SAME;
    return directed ? this->Input.Frames : TangentVectors(0, 2);
  }

  static bool IsTotalVariation(int kind) { return kind == EDGE_FUNCTION_TOTAL_VARIATION; }

  double TimeStep() const
  {
    return this->Units.ToCore(this->Filter.TimeStep, this->Time.Length, this->Time.Value);
  }
  double MeanEdgeLength() const { return this->Units.MeanEdgeLength / this->Units.LengthUnit; }
  double ValueRange() const { return this->Units.ValueRange / this->Units.ValueUnit; }
  SurfaceDiffusion::ChannelCoupling Coupling() const
  {
    return static_cast<SurfaceDiffusion::ChannelCoupling>(this->Filter.ChannelCoupling);
  }
  SurfaceDiffusion::FidelityNorm Norm() const
  {
    return static_cast<SurfaceDiffusion::FidelityNorm>(this->Filter.FidelityNorm);
  }

  const vtkIntrinsicTVFilter& Filter;
  ModelInput& Input;
  const UnitSystem& Units;
  const Dimension Time;
};

std::unique_ptr<Model> vtkIntrinsicTVFilter::MakeModel(ModelInput& input, int)
{
  const ModelMaker maker(*this, input, this->GetTimeDimension());
  double fidelity = this->FidelityWeight * maker.FidelityUnit();
  if (this->AutomaticFidelity)
  {
    fidelity = maker.FindFidelity();
  }
  this->EffectiveFidelityWeight = fidelity / maker.FidelityUnit();

  if (this->Discretization == DISCRETIZATION_LINEAR)
  {
    return maker.Make(input.Surface.Operators, std::move(input.Data), fidelity);
  }
  // Seconds for a million vertices: in the background an abort need not wait for them.
  struct EdgeUnknowns
  {
    std::shared_ptr<const MedialMesh> Mesh;
    std::shared_ptr<const Assembler> Operators;
  };
  const auto edges = std::make_shared<EdgeUnknowns>();
  RunInBackground(
    [edges, mesh = input.Surface.Mesh]
    {
      edges->Mesh = std::make_shared<MedialMesh>(*mesh);
      edges->Operators =
        std::make_shared<Assembler>(edges->Mesh->Edges(), SMPParallelFor::Instance());
    },
    input.Monitor.Part(0.5, 0.95));
  return std::make_unique<CrouzeixRaviartModel>(
    input.Surface.Operators, edges->Mesh, std::move(input.Data),
    [&](PointData data) { return maker.Make(edges->Operators, std::move(data), fidelity); },
    input.Parallel);
}

void vtkIntrinsicTVFilter::PrepareResult(const SurfaceRun& run, const ProgressMonitor&)
{
  double gap = 0.0;
  for (const StepRecord& record : run.Path->Records())
  {
    gap = std::max(gap, record.Residual);
  }
  const bool speaks = !run.Partition || run.Partition->GetProcesses().Rank() == 0;
  if (this->Minimizes() && gap > this->StopTolerance && speaks)
  {
    vtkWarningMacro(<< "the minimisation ended at its largest number of iterations with a relative "
                       "duality gap of "
                    << gap << ", above StopTolerance");
  }
}

bool vtkIntrinsicTVFilter::CanBeDistributed(const std::vector<SurfacePiece>&)
{
  return !this->AutomaticFidelity && this->Discretization == DISCRETIZATION_LINEAR;
}

void vtkIntrinsicTVFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
}

void vtkIntrinsicTVFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mode: " << this->GetModeAsString() << "\n";
  os << indent << "EdgeFunction: " << this->GetEdgeFunctionAsString() << "\n";
  os << indent << "AcrossEdgeFunction: " << this->GetAcrossEdgeFunctionAsString() << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "EdgeThreshold: " << this->EdgeThreshold << "\n";
  os << indent << "ChannelCoupling: " << this->GetChannelCouplingAsString() << "\n";
  os << indent << "FidelityNorm: " << this->GetFidelityNormAsString() << "\n";
  os << indent << "AutomaticFidelity: " << (this->AutomaticFidelity ? "On" : "Off") << "\n";
  os << indent << "NoiseLevel: " << this->NoiseLevel << "\n";
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
  os << indent << "Discretization: " << this->GetDiscretizationAsString() << "\n";
  os << indent << "StopTolerance: " << this->StopTolerance << "\n";
}
