// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/FidelitySearch.h"

#include "Core/Models/ColumnModels.h"
#include "Core/Models/HeatBlur.h"
#include "Core/Statistics/MeasuredVertices.h"
#include "Core/Statistics/NoiseCorrelation.h"
#include "Core/Statistics/NoiseLevel.h"
#include "Core/Statistics/RiskDirections.h"
#include "Core/Statistics/UnbiasedRisk.h"
#include "Core/Statistics/WeightSearch.h"
#include "Core/Vectors/TangentPlanes.h"
#include "Run/CorrelatedNoise.h"
#include "Run/DataPreparation.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// In first guesses of the search: keeps data to seven digits.
constexpr double WeightWithoutNoise = 1e8;

/// The changes of the data by which derivatives of states are found, over the noise. Larger ones are
/// smoothed by minimisers of total variation more than noise is.
constexpr double RiskStep = 0.2;

/// Of a component that is held: beside so large a weight, solvers would miss the others' tolerance.
constexpr double Held = std::numeric_limits<double>::infinity();

void MultiplyFactors(PointData& data, const Eigen::Ref<const Vector>& by)
{
  for (Eigen::Index i = 0; i < by.size(); ++i)
  {
    data.Fixed[i] =
      data.Fixed[i] || (by[i] == Held && data.FidelityFactor(static_cast<Index>(i)) > 0.0);
  }
  const Vector finite = (by.array() == Held).select(1.0, by);
  data.FidelityFactors =
    data.FidelityFactors.size() > 0 ? Vector(data.FidelityFactors.cwiseProduct(finite)) : finite;
}

/// Messages about several columns and components, of each kind the first, with the number of the
/// others.
class Notes
{
public:
  enum Kind
  {
    Correlated,
    Smooth,
    Undetermined,
    WithoutNoise,
    NotFound
  };

  void Add(Kind kind, const Sentence& text)
  {
    const auto found = this->Texts.insert({ kind, { text, 0 } }).first;
    ++found->second.second;
  }

  void AppendTo(RunResult& result) const
  {
    for (const auto& [kind, note] : this->Texts)
    {
      Sentence text = note.first;
      if (note.second > 1)
      {
        text << ", and likewise in " << note.second - 1
             << " more of the columns and connected components";
      }
      result.Warnings.push_back(text);
    }
  }

private:
  std::map<Kind, std::pair<Sentence, int>> Texts;
};

/// The search of some columns, for the weight of each connected component.
class ColumnSearch
{
public:
  ColumnSearch(const ModelInputs& inputs, const FidelityTask& task, PointData data, Notes& notes);

  bool IsDone() const
  {
    return std::all_of(this->Parts.begin(), this->Parts.end(),
      [](const Part& part) { return part.Search->IsDone(); });
  }
  /// Compare the states of models of the trial weights with the data.
  void Advance(const FidelityModelMaker& makeModel);
  void WarnIfNotFound(Notes& notes) const;

  /// That of the largest component; 1 on a surface without triangles.
  double Weight() const { return this->Parts.empty() ? 1.0 : this->Parts.front().Search->Trial(); }
  /// The weights over that of the largest component, per vertex; no entry if there is one.
  Vector Factors() const;

private:
  struct Part
  {
    VertexRange Vertices;
    double Noise;
    std::unique_ptr<WeightSearch> Search;
  };

  bool HasComparedValues(VertexRange range) const;
  NoiseEstimate Estimate(VertexRange range, Notes& notes);
  struct Noise
  {
    double Level = 0.0;
    bool IsWhite = true;
  };
  Noise FindNoise(VertexRange range, Notes& notes);
  double TypicalFactor(VertexRange range) const;
  double StartOf(VertexRange range) const;
  void SetDirections();
  void LeaveOutConstantParts(VertexRange range);
  void NoteSmoothData(double estimate, Notes& notes) const;
  std::unique_ptr<WeightSearch> MakeSearch(VertexRange range, const Noise& noise) const;
  /// The states that the models of the trial weights make of the data.
  Values Predict(PointData data, const FidelityModelMaker& makeModel) const;
  /// The states of the data, and of the data changed by the noise in each direction.
  std::vector<Values> PredictAll(const FidelityModelMaker& makeModel, std::size_t count) const;

  const ModelInputs& Inputs;
  const FidelityTask& Task;
  PointData Data;
  const SparsePattern Pattern;
  std::vector<Part> Parts; ///< connected components, the largest first
  std::optional<NoiseEstimate> OfAll; ///< for components of too few points
  PointData Compared; ///< the measured data that the result has to differ from by the noise
  std::vector<Values> Directions; ///< see SetRiskDirections(); as many as the smallest part needs
};

ColumnSearch::ColumnSearch(
  const ModelInputs& inputs, const FidelityTask& task, PointData data, Notes& notes)
  : Inputs(inputs)
  , Task(task)
  , Data(std::move(data))
  , Pattern(inputs.Surface.SharedAssembler()->Pattern())
  , Compared(this->Data)
{
  const std::vector<Index>& begin = inputs.Surface.Mesh().ComponentsBegin();
  std::vector<std::size_t> order(begin.size() - 1); // the largest first
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  const auto rangeOf = [&](std::size_t c) { return VertexRange{ begin[c], begin[c + 1] }; };
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return rangeOf(a).Size() > rangeOf(b).Size(); });
  for (const std::size_t c : order)
  {
    const VertexRange range = rangeOf(c);
    if (order.size() > 1 && !this->HasComparedValues(range))
    {
      this->Parts.push_back({ range, 0.0, std::make_unique<KnownWeight>(this->StartOf(range)) });
      continue;
    }
    const Noise noise = this->FindNoise(range, notes);
    this->Parts.push_back({ range, noise.Level, this->MakeSearch(range, noise) });
    if (noise.Level > 0.0)
    {
      this->LeaveOutConstantParts(range);
    }
  }
  this->SetDirections();
}

void ColumnSearch::SetDirections()
{
  const bool onCells = this->Inputs.Cells != nullptr;
  std::vector<VertexRange> ranges;
  for (const Part& part : this->Parts)
  {
    ranges.push_back(part.Vertices);
    if (part.Search->NeedsRisk())
    {
      const auto count = static_cast<std::size_t>(NumberOfRiskDirections(part.Vertices.Size()));
      if (onCells)
      {
        this->Directions.resize(std::max(this->Directions.size(), count));
        continue;
      }
      SetRiskDirections(this->Inputs.Surface.Mesh(), this->Pattern, this->Inputs.Surface.Points(),
        this->Compared, part.Vertices, part.Noise, count, this->Directions);
    }
  }
  if (onCells && !this->Directions.empty())
  {
    SetRiskDirectionsOfCells(*this->Inputs.Cells, this->Inputs.GivenCells, this->Data,
      this->Compared, ranges, NoiseGain(this->Inputs), this->Directions);
  }
  for (Values& direction : this->Directions)
  {
    if (this->Task.Planes)
    {
      direction = this->Task.Planes->Vectors(this->Task.Planes->Coordinates(direction), Values());
    }
  }
}

/// By the edges of the component, so that it does not depend on the others.
double ColumnSearch::StartOf(VertexRange range) const
{
  const TriangleMesh& mesh = this->Inputs.Surface.Mesh();
  const Points& points = this->Inputs.Surface.Points();
  double sum = 0.0;
  double count = 0.0;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    for (Index slot = this->Pattern.Outer[i]; slot < this->Pattern.Outer[i + 1]; ++slot)
    {
      const Index j = this->Pattern.Inner[slot];
      sum += (points.row(mesh.InputVertex()[i]) - points.row(mesh.InputVertex()[j])).norm();
      count += j != i ? 1.0 : 0.0;
    }
  }
  const double h = sum > 0.0 ? sum / count / mesh.LengthUnit() : 1.0;
  return 1.0 / (this->Task.StartsByArea ? h * h : h);
}

/// The risk is that of white noise. Correlated noise is left by the discrepancy principle. So is noise
/// on blurred data, where the risk of H u says little of the error of u: the best weights for it left
/// up to four times the best error of smooth data.
std::unique_ptr<WeightSearch> ColumnSearch::MakeSearch(VertexRange range, const Noise& noise) const
{
  if (noise.Level == 0.0)
  {
    return std::make_unique<KnownWeight>(WeightWithoutNoise * this->StartOf(range));
  }
  const double unit = this->Task.IsStartOverNoise ? noise.Level : 1.0;
  const double start = this->StartOf(range) / (unit * this->TypicalFactor(range));
  if (noise.IsWhite && !this->Task.Blur)
  {
    return std::make_unique<RiskSearch>(noise.Level, start, this->Task.NoiseLevel > 0.0);
  }
  return std::make_unique<DiscrepancySearch>(noise.Level, start);
}

/// The median of the fidelity factors that are not 0.
double ColumnSearch::TypicalFactor(VertexRange range) const
{
  std::vector<double> factors;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    if (const double factor = this->Data.FidelityFactor(i); factor > 0.0)
    {
      factors.push_back(factor);
    }
  }
  const auto middle = factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2);
  std::nth_element(factors.begin(), middle, factors.end());
  return factors.empty() ? 1.0 : *middle;
}

/// Whether a value of a weight other than 0 may change. Elsewhere all weights give the same.
bool ColumnSearch::HasComparedValues(VertexRange range) const
{
  for (Index i = range.Begin; i < range.End; ++i)
  {
    if (!this->Data.Fixed[i] && this->Data.FidelityFactor(i) > 0.0)
    {
      return true;
    }
  }
  return false;
}

NoiseEstimate ColumnSearch::Estimate(VertexRange range, Notes& notes)
{
  const Assembler& assembler = *this->Inputs.Surface.SharedAssembler();
  const Points& points = this->Inputs.Surface.Points();
  NoisyCoordinates coordinates;
  if (this->Task.Planes)
  {
    coordinates = [&](Index i, const Eigen::RowVectorXd& row)
    { return this->Task.Planes->CoordinatesAt(i, row); };
  }
  const auto estimate = [&](VertexRange vertices)
  {
    constexpr Index fewest = 40; // of fewer an estimate, and the risk, are those of the signal
    NoiseEstimate found;
    found.IsUndetermined = vertices.Size() < fewest;
    return found.IsUndetermined
      ? found
      : EstimateNoise(assembler, this->Pattern, points, this->Data, vertices, true, coordinates);
  };
  NoiseEstimate found = estimate(range);
  const VertexRange all{ 0, this->Inputs.Surface.Mesh().NumberOfVertices() };
  if (found.IsUndetermined && range.Size() < all.Size())
  {
    if (!this->OfAll)
    {
      this->OfAll = estimate(all);
    }
    found = *this->OfAll;
  }
  const double unit = this->Inputs.Units.ValueUnit;
  if (this->Task.NoiseLevel == 0.0 && !this->Inputs.Cells && found.IsCorrelated())
  {
    notes.Add(Notes::Correlated,
      Sentence("the noise is correlated: its standard deviation is ")
        << found.BetweenNeighbours * unit << " between neighbours and " << found.Level() * unit
        << " farther apart, which " << Word::Setting("AutomaticFidelity")
        << " uses (to set another, use " << Word::Setting("NoiseLevel") << ")");
  }
  return found;
}

ColumnSearch::Noise ColumnSearch::FindNoise(VertexRange range, Notes& notes)
{
  const bool isGiven = this->Task.NoiseLevel > 0.0;
  const NoiseEstimate estimate = this->Estimate(range, notes);
  const double between =
    estimate.BetweenNeighbours * (this->Inputs.Cells ? this->Task.CellNoiseGain : 1.0);
  const double estimated = this->Inputs.Cells ? between : estimate.Level();
  if (!isGiven && !this->Inputs.Cells && !estimate.IsCorrelated() && this->Parts.empty())
  {
    this->NoteSmoothData(this->Data.FidelityFactors.size() > 0
        ? EstimateNoise(*this->Inputs.Surface.SharedAssembler(), this->Pattern,
            this->Inputs.Surface.Points(), this->Data, range)
            .BetweenNeighbours
        : estimated,
      notes);
  }
  const double level = isGiven ? NoiseAtVertices(this->Inputs, this->Task.NoiseLevel) : estimated;
  if (level == 0.0)
  {
    Sentence text = Word::Setting("AutomaticFidelity");
    text << (estimate.IsUndetermined ? " finds too few known values, of a weight other than 0, to "
                                       "estimate the noise from, so "
                                       "that known values stay as they are"
                                     : " finds no noise in the data, which stay as they are")
         << " (to set the standard deviation of the noise, use " << Word::Setting("NoiseLevel")
         << ")";
    notes.Add(estimate.IsUndetermined ? Notes::Undetermined : Notes::WithoutNoise, text);
  }
  // Noise of more than the differences between neighbours is not white. That of cells is taken for it.
  const bool isWhite = estimate.IsUndetermined || this->Inputs.Cells ||
    level <= NoiseEstimate::CorrelatedGrowth * between;
  return { level, isWhite };
}

/// The estimate of noise between neighbours is that of white noise. A note if there is none.
void ColumnSearch::NoteSmoothData(double estimate, Notes& notes) const
{
  const NeighbourVariation variation = MeasureVariation(
    *this->Inputs.Surface.SharedAssembler(), this->Inputs.Surface.Points(), this->Data, estimate);
  if (!variation.IsSmooth())
  {
    return;
  }
  const double unit = this->Inputs.Units.ValueUnit;
  notes.Add(Notes::Smooth,
    DescribeSmoothData(variation.Width, estimate * unit, variation.Deviation * unit,
      Sentence("set ") << Word::Setting("NoiseLevel")));
}

void ColumnSearch::LeaveOutConstantParts(VertexRange range)
{
  const Flags varying =
    FindVaryingVertices(*this->Inputs.Surface.SharedAssembler(), this->Pattern, this->Data, range);
  auto missing = this->Compared.Missing.segment(range.Begin, range.Size());
  if (varying.any())
  {
    missing = !varying;
  }
  else if (this->Data.Measured)
  {
    missing = missing || this->Data.Measured->IsBetween.segment(range.Begin, range.Size());
  }
}

Vector ColumnSearch::Factors() const
{
  Vector factors;
  if (this->Parts.size() > 1)
  {
    factors.resize(this->Data.Given.rows());
    const bool canHold = !this->Task.Blur && !this->Inputs.Cells;
    for (const Part& part : this->Parts)
    {
      factors.segment(part.Vertices.Begin, part.Vertices.Size())
        .setConstant(part.Noise == 0.0 && canHold ? Held : part.Search->Trial() / this->Weight());
    }
  }
  return factors;
}

Values ColumnSearch::Predict(PointData data, const FidelityModelMaker& makeModel) const
{
  const Vector factors = this->Factors();
  if (factors.size() > 0)
  {
    MultiplyFactors(data, factors);
  }
  const std::unique_ptr<Model> model = makeModel(std::move(data), this->Weight());
  for (int step = 0; step < this->Task.Steps; ++step)
  {
    model->Advance(this->Inputs.Progress.Part(0.5, 0.5));
  }
  Values predicted = model->State();
  if (this->Task.Blur)
  {
    StepReport unused;
    this->Task.Blur->Apply(predicted, unused);
  }
  return predicted;
}

std::vector<Values> ColumnSearch::PredictAll(
  const FidelityModelMaker& makeModel, std::size_t count) const
{
  std::vector<PointData> data(1 + count, this->Data);
  for (const Part& part : this->Parts)
  {
    const auto rows = Eigen::seqN(part.Vertices.Begin, part.Vertices.Size());
    for (std::size_t d = 0; d < count; ++d)
    {
      const Values change = RiskStep * part.Noise * this->Directions[d](rows, Eigen::all);
      data[1 + d].Given(rows, Eigen::all) += change;
      data[1 + d].Start(rows, Eigen::all) += change;
    }
  }
  std::vector<Values> states;
  if (!this->Task.IsLinear)
  {
    for (PointData& one : data)
    {
      states.push_back(this->Predict(std::move(one), makeModel));
    }
    return states;
  }
  // One model with the columns of all of them: one matrix.
  const Eigen::Index columns = this->Data.Given.cols();
  PointData together = this->Data;
  for (const auto member : { &PointData::Given, &PointData::Start })
  {
    Values values(together.Given.rows(), columns * static_cast<Eigen::Index>(data.size()));
    for (std::size_t d = 0; d < data.size(); ++d)
    {
      values.middleCols(static_cast<Eigen::Index>(d) * columns, columns) = data[d].*member;
    }
    together.*member = std::move(values);
  }
  const Values state = this->Predict(std::move(together), makeModel);
  for (std::size_t d = 0; d < data.size(); ++d)
  {
    states.emplace_back(state.middleCols(static_cast<Eigen::Index>(d) * columns, columns));
  }
  return states;
}

void ColumnSearch::Advance(const FidelityModelMaker& makeModel)
{
  int count = 0;
  for (const Part& part : this->Parts)
  {
    count = part.Search->IsDone() || !part.Search->NeedsRisk()
      ? count
      : std::max(count, NumberOfRiskDirections(part.Vertices.Size()));
  }
  std::vector<Values> changed = this->PredictAll(makeModel, static_cast<std::size_t>(count));
  const Values state = std::move(changed.front());
  changed.erase(changed.begin());
  for (Part& part : this->Parts)
  {
    if (!part.Search->IsDone())
    {
      const int needed =
        part.Search->NeedsRisk() ? NumberOfRiskDirections(part.Vertices.Size()) : 0;
      NoiseResponse response = MeasureNoiseResponse(this->Inputs.Surface.Mesh(), this->Compared,
        state, changed, this->Directions, needed, RiskStep * part.Noise, part.Vertices);
      if (this->Task.Planes)
      {
        response.Scale(1.5); // two of three dimensions have noise
      }
      part.Search->Take(response);
    }
  }
}

void ColumnSearch::WarnIfNotFound(Notes& notes) const
{
  const double unit = this->Inputs.Units.ValueUnit;
  for (const Part& part : this->Parts)
  {
    const FidelityChoice found = part.Search->Found();
    if (!found.IsFound)
    {
      notes.Add(Notes::NotFound,
        Sentence(Word::Setting("AutomaticFidelity"))
          << " found no weight at which the result differs from the data by the noise, "
          << part.Noise * unit << ": at the end of its search the difference is "
          << found.Discrepancy * unit);
    }
  }
}

} // namespace

std::unique_ptr<Model> FidelityWeights::MakeModels(
  PointData data, const FidelityModelMaker& makeModel) const
{
  const auto groups = static_cast<Eigen::Index>(this->OfColumns.size());
  std::vector<std::unique_ptr<Model>> models;
  for (Eigen::Index g = 0; g < groups; ++g)
  {
    PointData some = groups > 1 ? DataOfColumns(data, g, 1) : std::move(data);
    if (this->Factors.rows() > 0)
    {
      MultiplyFactors(some, this->Factors.col(g));
    }
    models.push_back(makeModel(std::move(some), this->OfColumns[static_cast<std::size_t>(g)]));
  }
  return groups > 1 ? std::make_unique<ColumnModels>(std::move(models)) : std::move(models.front());
}

FidelityWeights FindFidelity(const ModelInputs& inputs, const FidelityTask& given,
  const FidelityModelMaker& makeModel, RunResult& result)
{
  FidelityTask task = given;
  if (inputs.Cells && task.NoiseLevel == 0.0)
  {
    task.CellNoiseGain = FindCellNoiseGain(inputs);
  }
  const Eigen::Index all = inputs.Data.Given.cols();
  const Eigen::Index together = task.ColumnsShareWeight ? all : 1;
  Notes notes;
  FidelityWeights weights;
  for (Eigen::Index first = 0; first < all; first += together)
  {
    ColumnSearch search(inputs, task, DataOfColumns(inputs.Data, first, together), notes);
    while (!search.IsDone())
    {
      search.Advance(makeModel);
    }
    search.WarnIfNotFound(notes);
    weights.OfColumns.push_back(search.Weight());
    const Vector factors = search.Factors();
    if (factors.size() > 0)
    {
      weights.Factors.conservativeResize(factors.size(), weights.Factors.cols() + 1);
      weights.Factors.rightCols(1) = factors;
    }
  }
  result.FidelityFactors = weights.Factors;
  notes.AppendTo(result);
  return weights;
}

} // namespace SurfaceDiffusion
