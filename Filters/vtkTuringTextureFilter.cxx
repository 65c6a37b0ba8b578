// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTuringTextureFilter.h"

#include "Conversion/ConvertValue.h"
#include "Conversion/EnumText.h"
#include "Conversion/InputArrays.h"
#include "Conversion/NewArray.h"
#include "Conversion/PointArrays.h"
#include "Conversion/SurfaceRun.h"
#include "Core/Models/DispersionRelation.h"
#include "Core/Models/ReactionDiffusion.h"
#include "Core/Models/TextureColors.h"
#include "Core/Operators/CotanWeights.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkTuringTextureFilter);

/// g1 and g2 of both chemicals in LengthUnit^2 ReactionRate, per triangle of the mesh, and their
/// means over the surface.
struct vtkTuringTextureFilter::Rates
{
  std::array<Vector, 2> Along, Across;
  std::array<double, 2> MeanAlong, MeanAcross;

  void Scale(double factor)
  {
    for (int c = 0; c < 2; ++c)
    {
      this->Along[c] *= factor;
      this->Across[c] *= factor;
      this->MeanAlong[c] *= factor;
      this->MeanAcross[c] *= factor;
    }
  }
};

namespace
{

constexpr double EdgesPerWavelength = 6.0;

std::string Quantity(double value)
{
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

Eigen::Matrix2d JacobianAtRest(
  const SurfaceDiffusion::Kinetics& terms, const KineticsParameters& parameters)
{
  const Eigen::Vector2d steady = terms.SteadyState(parameters);
  return terms.Jacobian(parameters, steady[0], steady[1]);
}

/// Why no pattern grows; empty where one does.
std::string Explain(const PatternForecast& forecast, double rate1, double rate2)
{
  switch (forecast.Obstacle)
  {
    case PatternObstacle::NoSteadyState:
      return "the kinetics have no steady state with these parameters, out of which a pattern "
             "could "
             "grow";
    case PatternObstacle::NotSteady:
      return "the steady state of the kinetics runs away even without diffusion: all of the "
             "surface "
             "may oscillate together instead of standing in a pattern";
    case PatternObstacle::NoActivator:
      return "no pattern grows: neither chemical promotes itself with these parameters";
    case PatternObstacle::RatesTooClose:
    {
      const bool first = forecast.FirstIsFaster;
      return std::string("no pattern grows: the diffusion rate of ") + (first ? "u1" : "u2") +
        " must be more than " + Quantity(forecast.CriticalRatio) + " times that of " +
        (first ? "u2" : "u1") + ", and is " + Quantity(first ? rate1 / rate2 : rate2 / rate1) +
        " times";
    }
    case PatternObstacle::None:
      break;
  }
  return std::string();
}

double WavelengthOf(const PatternForecast& forecast)
{
  return forecast.SquaredWaveNumber > 0.0
    ? 2.0 * std::acos(-1.0) / std::sqrt(forecast.SquaredWaveNumber)
    : 0.0;
}

/// An array of one value per point, 0 where a point takes no part, unless `source` has a value.
template <typename Array>
vtkSmartPointer<vtkDataArray> MakePointArray(const PolyDataSurface& surface,
  const std::string& name, const Eigen::Ref<const Vector>& values, vtkDataArray* source,
  int component)
{
  const auto count = static_cast<vtkIdType>(surface.PointToVertex.size());
  auto array = NewArray<Array>(name, 1, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const Index v = surface.PointToVertex[i];
    const double elsewhere = source ? source->GetComponent(i, component) : 0.0;
    array->SetValue(i, ConvertValue<typename Array::ValueType>(v >= 0 ? values[v] : elsewhere));
  }
  return array;
}

vtkSmartPointer<vtkDataArray> MakePointArray(bool single, const PolyDataSurface& surface,
  const std::string& name, const Eigen::Ref<const Vector>& values, vtkDataArray* source = nullptr,
  int component = 0)
{
  return single ? MakePointArray<vtkFloatArray>(surface, name, values, source, component)
                : MakePointArray<vtkDoubleArray>(surface, name, values, source, component);
}

} // namespace

vtkTuringTextureFilter::vtkTuringTextureFilter()
{
  this->TimeIntegrator = TIME_INTEGRATOR_SECOND_ORDER;
  this->TimeStep = 1.0 / 16.0;
  this->NumberOfTimeSteps = 640;
  // No data are needed: active scalars are not meant.
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
}

const char* vtkTuringTextureFilter::GetKineticsAsString()
{
  return this->Kinetics >= 0 && this->Kinetics < NumberOfKinetics
    ? SurfaceDiffusion::GetKinetics(static_cast<KineticsName>(this->Kinetics)).Name
    : "Unknown";
}

const char* vtkTuringTextureFilter::GetTextureChemicalAsString()
{
  return EnumText(this->TextureChemical, { "U1", "U2" });
}

void vtkTuringTextureFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetKineticsToTuring();
}

std::array<double, 3> vtkTuringTextureFilter::GetKineticsParameters()
{
  switch (static_cast<KineticsName>(this->Kinetics))
  {
    case KineticsName::Turing:
      return { this->GrowthRate, this->DecayRate, 0.0 };
    case KineticsName::Schnakenberg:
      return { this->ActivatorSupply, this->SubstrateSupply, 0.0 };
    case KineticsName::GrayScott:
      return { this->FeedRate, this->KillRate, 0.0 };
    case KineticsName::Brusselator:
      return { this->ReactantA, this->ReactantB, 0.0 };
    case KineticsName::GiererMeinhardt:
      return { this->InhibitorDecayRate, this->Saturation, 0.0 };
    case KineticsName::FitzHughNagumo:
      break;
  }
  return { this->RecoveryRate, this->RecoveryDamping, this->Stimulus };
}

void vtkTuringTextureFilter::CheckProperties(Problems& problems)
{
  this->Superclass::CheckProperties(problems);
  const auto require = [&](bool holds, const char* property, double value, const char* allowed)
  { Require(holds, property, value, allowed, problems); };
  const auto notNegative = [](double x) { return std::isfinite(x) && x >= 0.0; };
  const char* const finite = "finite numbers, 0 or more";
  require(this->TimeIntegrator == TIME_INTEGRATOR_FIRST_ORDER ||
      this->TimeIntegrator == TIME_INTEGRATOR_SECOND_ORDER,
    "TimeIntegrator", this->TimeIntegrator, "0 FirstOrder, 1 SecondOrder");
  require(this->FidelityWeight == 0.0, "FidelityWeight", this->FidelityWeight,
    "0: reaction-diffusion has no fidelity");
  const char* const one = "1: the rates are DiffusionRate1 and so on here";
  require(this->AlongDiffusivity == 1.0, "AlongDiffusivity", this->AlongDiffusivity, one);
  require(this->AcrossDiffusivity == 1.0, "AcrossDiffusivity", this->AcrossDiffusivity, one);
  require(std::isfinite(this->ReactionRate) && this->ReactionRate > 0.0, "ReactionRate",
    this->ReactionRate, "finite numbers above 0");
  require(notNegative(this->DiffusionRate1), "DiffusionRate1", this->DiffusionRate1, finite);
  require(notNegative(this->DiffusionRate2), "DiffusionRate2", this->DiffusionRate2, finite);
  const auto across = [&](const char* property, double value)
  {
    require(notNegative(value) || value == -1.0, property, value,
      "finite numbers, 0 or more, or -1: as along");
  };
  across("DiffusionRateAcross1", this->DiffusionRateAcross1);
  across("DiffusionRateAcross2", this->DiffusionRateAcross2);
  require(notNegative(this->FeatureSize), "FeatureSize", this->FeatureSize, finite);
  require(notNegative(this->InitialNoise), "InitialNoise", this->InitialNoise, finite);
  require(notNegative(this->StopTolerance), "StopTolerance", this->StopTolerance, finite);
  require(
    this->TextureChemical == TEXTURE_CHEMICAL_U1 || this->TextureChemical == TEXTURE_CHEMICAL_U2,
    "TextureChemical", this->TextureChemical, "0 U1, 1 U2");
  for (int k = 0; k < 3; ++k)
  {
    const auto share = [](double x) { return x >= 0.0 && x <= 1.0; };
    require(share(this->LowColor[k]), "LowColor", this->LowColor[k], "numbers from 0 to 1");
    require(share(this->HighColor[k]), "HighColor", this->HighColor[k], "numbers from 0 to 1");
  }
  const bool known = this->Kinetics >= 0 && this->Kinetics < NumberOfKinetics;
  require(known, "Kinetics", this->Kinetics,
    "0 Turing, 1 Schnakenberg, 2 GrayScott, 3 Brusselator, 4 GiererMeinhardt, 5 FitzHughNagumo");
  if (!known)
  {
    return;
  }
  const auto& terms = SurfaceDiffusion::GetKinetics(static_cast<KineticsName>(this->Kinetics));
  const KineticsParameters values = this->GetKineticsParameters();
  for (std::size_t p = 0; p < values.size(); ++p)
  {
    const SurfaceDiffusion::Kinetics::Parameter& parameter = terms.Parameters[p];
    if (parameter.Name)
    {
      const std::string above = "finite numbers above " + Quantity(parameter.Minimum);
      require(std::isfinite(values[p]) && values[p] > parameter.Minimum, parameter.Name, values[p],
        parameter.Minimum == 0.0     ? above.c_str()
          : parameter.Minimum < -1.0 ? "finite numbers"
                                     : finite);
    }
  }
}

bool vtkTuringTextureFilter::AreRatesDirected()
{
  const auto differs = [](double along, double across)
  { return across != -1.0 && across != along; };
  return differs(this->DiffusionRate1, this->DiffusionRateAcross1) ||
    differs(this->DiffusionRate2, this->DiffusionRateAcross2);
}

bool vtkTuringTextureFilter::FindArrays(vtkPolyData* block, BlockArrays& arrays, Problems& problems)
{
  const InputArrays inputs(this, block, problems);
  const std::size_t before = problems.size();
  vtkInformation* const data = this->GetInputArrayInformation(0);
  const char* const name =
    data->Has(vtkDataObject::FIELD_NAME()) ? data->Get(vtkDataObject::FIELD_NAME()) : "";
  if (data->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) || (name && *name))
  {
    arrays.Data = inputs.FindOnPoints(0, "InputArray", 2);
  }
  arrays.Mask = inputs.FindOnPoints(1, "MaskArray", 1);
  arrays.Direction = inputs.Find(2, "DirectionArray", 3, arrays.DirectionOnCells);
  arrays.Fixed = inputs.FindOnPoints(3, "FixedArray", 1);
  bool onCells = true;
  arrays.Rates = inputs.Find(4, "DiffusionRateArray", 4, onCells);
  const auto tell = [&](bool wrong, const char* what)
  {
    if (wrong && problems.size() == before)
    {
      problems.emplace_back(what);
    }
  };
  tell(arrays.Data && NumberOfDataComponents(arrays.Data) != 2,
    "InputArray holds colours, whose last component is alpha; allowed: 2 components of a type "
    "other than unsigned char");
  tell(arrays.Rates && !onCells,
    "DiffusionRateArray is a point array; allowed: arrays of 4 components per cell");
  tell(arrays.Rates && this->IntrinsicDelaunay,
    "IntrinsicDelaunay is on but DiffusionRateArray gives rates per cell, whose triangles it would "
    "replace; allowed: one of the two");
  tell(!arrays.Direction && !arrays.Rates && this->AreRatesDirected(),
    "DiffusionRateAcross1 or DiffusionRateAcross2 differs from the rate along but DirectionArray "
    "is not set; allowed: -1, or an array of directions");
  tell(arrays.Fixed && !arrays.Data,
    "FixedArray is set but InputArray, the values to hold, is not; allowed: both or neither");
  return problems.size() == before;
}

void vtkTuringTextureFilter::WriteRunKey(std::ostream& key)
{
  this->Superclass::WriteRunKey(key);
  for (const double value : { static_cast<double>(this->Kinetics), this->ReactionRate,
         this->DiffusionRate1, this->DiffusionRate2, this->DiffusionRateAcross1,
         this->DiffusionRateAcross2, this->FeatureSize, this->InitialNoise,
         this->ClampToNonNegative ? 1.0 : 0.0, this->StopTolerance })
  {
    key << value << ' ';
  }
  for (const double value : this->GetKineticsParameters())
  {
    key << value << ' ';
  }
}

double vtkTuringTextureFilter::GetEffectiveTimeStep()
{
  if (!this->AutomaticTimeStep || this->Kinetics < 0 || this->Kinetics >= NumberOfKinetics)
  {
    return this->TimeStep;
  }
  const double step = ReactionTimeStep(
    JacobianAtRest(SurfaceDiffusion::GetKinetics(static_cast<KineticsName>(this->Kinetics)),
      this->GetKineticsParameters()));
  if (!std::isfinite(step))
  {
    return this->TimeStep; // no steady state
  }
  return this->GetTimeIsAbsolute() ? step / this->ReactionRate : step;
}

vtkTuringTextureFilter::Rates vtkTuringTextureFilter::MakeRates(const ModelInput& input)
{
  const TriangleMesh& mesh = *input.Surface.Mesh;
  const UnitSystem& units = input.Units;
  const double unit = units.ToCore(1.0, 2.0, 0.0) / (units.Natural ? 1.0 : this->ReactionRate);
  const auto orAlong = [](double across, double along) { return across == -1.0 ? along : across; };
  const double constant[4] = { this->DiffusionRate1,
    orAlong(this->DiffusionRateAcross1, this->DiffusionRate1), this->DiffusionRate2,
    orAlong(this->DiffusionRateAcross2, this->DiffusionRate2) };
  Rates rates;
  for (int c = 0; c < 2; ++c)
  {
    rates.MeanAlong[c] = unit * constant[2 * c];
    rates.MeanAcross[c] = unit * constant[2 * c + 1];
    rates.Along[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c]);
    rates.Across[c] = Vector::Constant(mesh.NumberOfTriangles(), constant[2 * c + 1]);
  }
  input.Together(
    [&]
    {
      if (input.Arrays.Rates)
      {
        this->ReadRates(input, rates);
      }
    });
  const Reduction& reduction = mesh.GetReduction();
  if (reduction.Any(input.Arrays.Rates))
  {
    const auto mean = [&](const Vector& rate)
    {
      double area = 0.0;
      double sum = 0.0;
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        area += mesh.Shapes()[t].Area();
        sum += mesh.Shapes()[t].Area() * unit * rate[t];
      }
      area = reduction.Sum(area);
      sum = reduction.Sum(sum);
      return area > 0.0 ? sum / area : 0.0;
    };
    for (int c = 0; c < 2; ++c)
    {
      rates.MeanAlong[c] = mean(rates.Along[c]);
      rates.MeanAcross[c] = mean(rates.Across[c]);
    }
  }
  for (int c = 0; c < 2; ++c)
  {
    rates.Along[c] *= unit;
    rates.Across[c] *= unit;
  }
  return rates;
}

/// Those of DiffusionRateArray, in its own unit.
void vtkTuringTextureFilter::ReadRates(const ModelInput& input, Rates& rates)
{
  const TriangleMesh& mesh = *input.Surface.Mesh;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const vtkIdType cell = input.Surface.TriangleCells[mesh.InputTriangle()[t]];
    for (int k = 0; k < 4; ++k)
    {
      const double rate = input.Arrays.Rates->GetComponent(cell, k);
      if (!(std::isfinite(rate) && rate >= 0.0))
      {
        throw std::runtime_error("DiffusionRateArray is " + Quantity(rate) + " at cell " +
          std::to_string(cell) + "; allowed: finite numbers, 0 or more");
      }
      (k % 2 == 0 ? rates.Along : rates.Across)[k / 2][t] = rate;
    }
  }
  const bool directed = rates.Along[0] != rates.Across[0] || rates.Along[1] != rates.Across[1];
  if (directed && !input.Arrays.Direction)
  {
    throw std::runtime_error("DiffusionRateArray has other rates across than along but "
                             "DirectionArray is not set; allowed: the same, or an array of "
                             "directions");
  }
}

/// Scale the rates to FeatureSize, and tell what stands against a pattern.
void vtkTuringTextureFilter::ChooseFeatureSize(ModelInput& input, Rates& rates)
{
  const Eigen::Matrix2d jacobian =
    JacobianAtRest(SurfaceDiffusion::GetKinetics(static_cast<KineticsName>(this->Kinetics)),
      this->GetKineticsParameters());
  PatternForecast forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
  this->DiffusionRateFactor = 1.0;
  if (this->FeatureSize > 0.0)
  {
    const double factor = FeatureSizeFactor(forecast, this->FeatureSize / input.Units.LengthUnit);
    if (std::isfinite(factor) && factor > 0.0)
    {
      this->DiffusionRateFactor = factor;
      rates.Scale(factor);
      forecast = ForecastPattern(jacobian, rates.MeanAlong[0], rates.MeanAlong[1]);
    }
    else
    {
      input.Warnings.emplace_back("FeatureSize has no effect: with these rates and parameters no "
                                  "wave grows faster than the uniform state");
    }
  }
  this->Wavelength = WavelengthOf(forecast) * input.Units.LengthUnit;
  const bool absolute = this->GetTimeIsAbsolute();
  this->WavelengthGrowthRate = forecast.GrowthRate * (absolute ? this->ReactionRate : 1.0);

  const PatternForecast across =
    ForecastPattern(jacobian, rates.MeanAcross[0], rates.MeanAcross[1]);
  const bool grows =
    forecast.Obstacle == PatternObstacle::None || across.Obstacle == PatternObstacle::None;
  const std::string reason = Explain(forecast, rates.MeanAlong[0], rates.MeanAlong[1]);
  if (!grows && !reason.empty())
  {
    input.Warnings.push_back(reason);
  }
  double shortest = 0.0; // of the waves that grow
  for (const PatternForecast& wave : { forecast, across })
  {
    const double length = WavelengthOf(wave) * input.Units.LengthUnit;
    if (wave.Obstacle == PatternObstacle::None && length > 0.0)
    {
      shortest = shortest > 0.0 ? std::min(shortest, length) : length;
    }
  }
  if (shortest > 0.0 && shortest < EdgesPerWavelength * input.Units.MeanEdgeLength)
  {
    input.Warnings.push_back("the pattern's wavelength " + Quantity(shortest) + " is only " +
      Quantity(shortest / input.Units.MeanEdgeLength) +
      " mean edge lengths, which the mesh cannot resolve; allow at least " +
      Quantity(EdgesPerWavelength) + ", that is, " +
      Quantity(EdgesPerWavelength * input.Units.MeanEdgeLength));
  }
}

std::unique_ptr<Model> vtkTuringTextureFilter::MakeModel(ModelInput& input, int steps)
{
  const TriangleMesh& mesh = *input.Surface.Mesh;
  Rates rates = this->MakeRates(input);
  this->ChooseFeatureSize(input, rates);

  Reaction reaction; // in units of 1/ReactionRate
  reaction.Terms = &SurfaceDiffusion::GetKinetics(static_cast<KineticsName>(this->Kinetics));
  reaction.Parameters = this->GetKineticsParameters();
  if (input.Data.Start.cols() == 0)
  {
    if (!reaction.Terms->SteadyState(reaction.Parameters).allFinite())
    {
      throw std::runtime_error(std::string("Kinetics is ") + reaction.Terms->Name +
        ", which has no steady state with these parameters to start from; allowed: others (for "
        "Turing GrowthRate above DecayRate), or an initial state as InputArray");
    }
    input.Data = PointData::FromValues(
      NoisySteadyState(reaction, this->InitialNoise, this->RandomSeed, input.Ids));
  }

  const bool absolute = this->GetTimeIsAbsolute();
  const bool secondOrder = this->TimeIntegrator == TIME_INTEGRATOR_SECOND_ORDER;
  ReactionDiffusion::Settings settings;
  settings.TimeStep = this->GetEffectiveTimeStep() * (absolute ? this->ReactionRate : 1.0);
  settings.TimeScheme =
    secondOrder ? ReactionDiffusion::Scheme::SecondOrder : ReactionDiffusion::Scheme::FirstOrder;
  settings.KeepNonNegative = this->ClampToNonNegative && reaction.Terms->NonNegative;
  settings.StopTolerance = this->StopTolerance / (absolute ? this->ReactionRate : 1.0);

  const double h = input.Units.MeanEdgeLength / input.Units.LengthUnit;
  const CornerWeights isotropic = CotanWeights(mesh, input.Parallel);
  const TangentVectors frames = input.Frames.rows() > 0
    ? input.Frames
    : TangentVectors(TangentVectors::Zero(mesh.NumberOfTriangles(), 2));
  std::array<ReactionDiffusion::Chemical, 2> chemicals;
  bool direct = true;
  for (int c = 0; c < 2; ++c)
  {
    const double fastest = std::max(rates.MeanAlong[c], rates.MeanAcross[c]);
    SolverTask task;
    task.NumberOfVertices = mesh.NumberOfVertices();
    task.DiffusionNumber = fastest * settings.TimeStep / (h * h);
    task.NumberOfSolves = secondOrder ? 2.0 * steps : steps;
    task.Tolerance = this->Tolerance;
    direct = direct &&
      (this->Solver == SOLVER_DIRECT ||
        (this->Solver == SOLVER_AUTOMATIC &&
          ChooseSolver(SolverMethod::Automatic, task).Method == SolverMethod::Factorization));
    chemicals[c].Solver = input.Solver(c == 0 ? "u1" : "u2", task);
    chemicals[c].Coefficients =
      AnisotropicWeights(mesh, isotropic, frames, rates.Along[c], rates.Across[c], input.Parallel);
  }
  settings.SideBySide = direct && mesh.GetReduction().IsSerial();
  return std::make_unique<ReactionDiffusion>(input.Surface.Operators, reaction,
    std::move(chemicals), std::move(input.Data), settings, input.Parallel);
}

void vtkTuringTextureFilter::PrepareResult(const SurfaceRun& run, const ProgressMonitor&)
{
  this->ContrastLimits[&run] = SurfaceDiffusion::ContrastLimits(
    run.Path->State().col(this->TextureChemical), run.Surface->Mesh->GetReduction());
}

void vtkTuringTextureFilter::WriteResult(
  const SurfaceRun& run, const BlockArrays& arrays, vtkPolyData* output)
{
  const bool single = this->OutputPrecision == OUTPUT_PRECISION_SINGLE ||
    (this->OutputPrecision == OUTPUT_PRECISION_INPUT && arrays.Data &&
      arrays.Data->GetDataType() == VTK_FLOAT);
  vtkPointData* const points = output->GetPointData();
  const Values& u = run.Path->State();
  for (int c = 0; c < 2; ++c)
  {
    const std::string name = this->ResultArrayName + (c == 0 ? "u1" : "u2");
    points->AddArray(MakePointArray(single, *run.Surface, name, u.col(c), arrays.Data, c));
  }
  const Vector texture =
    StretchContrast(u.col(this->TextureChemical), this->ContrastLimits.extract(&run).mapped());
  points->AddArray(
    MakePointArray(single, *run.Surface, this->ResultArrayName + "Texture", texture));
  std::string active = this->ResultArrayName + "u1";
  if (this->ColorOutput)
  {
    active = this->ResultArrayName + "TextureColor";
    const std::array<double, 3> low = { this->LowColor[0], this->LowColor[1], this->LowColor[2] };
    const std::array<double, 3> high = { this->HighColor[0], this->HighColor[1],
      this->HighColor[2] };
    const Colors ofVertices = MixColors(texture, low, high);
    const Colors elsewhere = MixColors(Vector::Zero(1), low, high);
    const auto colors = NewArray<vtkUnsignedCharArray>(active, 3, output->GetNumberOfPoints());
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      const Index v = run.Surface->PointToVertex[i];
      colors->SetTypedTuple(i, v >= 0 ? ofVertices.row(v).data() : elsewhere.data());
    }
    points->AddArray(colors);
  }
  points->SetActiveScalars(active.c_str());
}

void vtkTuringTextureFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->Wavelength);
  visit(this->WavelengthGrowthRate);
  visit(this->DiffusionRateFactor);
}

void vtkTuringTextureFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kinetics: " << this->GetKineticsAsString() << "\n";
  os << indent << "ReactionRate: " << this->ReactionRate << "\n";
  os << indent << "DiffusionRate1: " << this->DiffusionRate1 << "\n";
  os << indent << "DiffusionRate2: " << this->DiffusionRate2 << "\n";
  os << indent << "DiffusionRateAcross1: " << this->DiffusionRateAcross1 << "\n";
  os << indent << "DiffusionRateAcross2: " << this->DiffusionRateAcross2 << "\n";
  os << indent << "FeatureSize: " << this->FeatureSize << "\n";
  os << indent << "InitialNoise: " << this->InitialNoise << "\n";
  os << indent << "ClampToNonNegative: " << (this->ClampToNonNegative ? "On" : "Off") << "\n";
  os << indent << "AutomaticTimeStep: " << (this->AutomaticTimeStep ? "On" : "Off") << "\n";
  os << indent << "StopTolerance: " << this->StopTolerance << "\n";
  os << indent << "GrowthRate: " << this->GrowthRate << "\n";
  os << indent << "DecayRate: " << this->DecayRate << "\n";
  os << indent << "ActivatorSupply: " << this->ActivatorSupply << "\n";
  os << indent << "SubstrateSupply: " << this->SubstrateSupply << "\n";
  os << indent << "FeedRate: " << this->FeedRate << "\n";
  os << indent << "KillRate: " << this->KillRate << "\n";
  os << indent << "ReactantA: " << this->ReactantA << "\n";
  os << indent << "ReactantB: " << this->ReactantB << "\n";
  os << indent << "InhibitorDecayRate: " << this->InhibitorDecayRate << "\n";
  os << indent << "Saturation: " << this->Saturation << "\n";
  os << indent << "RecoveryRate: " << this->RecoveryRate << "\n";
  os << indent << "RecoveryDamping: " << this->RecoveryDamping << "\n";
  os << indent << "Stimulus: " << this->Stimulus << "\n";
  os << indent << "TextureChemical: " << this->GetTextureChemicalAsString() << "\n";
  os << indent << "ColorOutput: " << (this->ColorOutput ? "On" : "Off") << "\n";
  os << indent << "LowColor: " << this->LowColor[0] << " " << this->LowColor[1] << " "
     << this->LowColor[2] << "\n";
  os << indent << "HighColor: " << this->HighColor[0] << " " << this->HighColor[1] << " "
     << this->HighColor[2] << "\n";
  os << indent << "Wavelength: " << this->Wavelength << "\n";
  os << indent << "WavelengthGrowthRate: " << this->WavelengthGrowthRate << "\n";
  os << indent << "DiffusionRateFactor: " << this->DiffusionRateFactor << "\n";
}
