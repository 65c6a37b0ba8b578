// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Solve.h"

#include "Core/Statistics/NoiseWidth.h"
#include "Run/ErrorCauses.h"
#include "Run/Outputs.h"
#include "Run/Run.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The names of input arrays in Fields.
const std::map<std::string, std::string> NamesOfArrays = { { "InputArray", "Data" },
  { "DataTermArray", "Data" }, { "MaskArray", "Mask" }, { "DirectionArray", "Directions" },
  { "FixedArray", "Fixed" }, { "DiffusionRateArray", "Rates" },
  { "FidelityArray", "FidelityFactors" }, { "SeedArray", "Seeds" }, { "CreaseArray", "Seeds" },
  { "SourceArray", "Data" }, { "SpeedArray", "Speeds" }, { "AlongSpeedArray", "AlongSpeeds" },
  { "AcrossSpeedArray", "AcrossSpeeds" }, { "SourceTimes", "StartTimes" },
  { "SlopeErrorArray", "SlopeErrors" } };

/// work(), whose errors are in the words of this interface.
template <typename Work>
auto WordErrors(const Work& work)
{
  try
  {
    return work();
  }
  catch (const InputError& error)
  {
    throw std::runtime_error(error.Message().Text(NamesOfArrays));
  }
}

void RequireRows(
  const char* name, std::size_t found, std::size_t expected, bool onCells, Problems& problems)
{
  if (found != 0 && found != expected)
  {
    problems.push_back(std::string(name) + " has " + std::to_string(found) +
      " rows; allowed: " + std::to_string(expected) + ", one per " + (onCells ? "cell" : "point"));
  }
}

/// The arrays of a call, which outlive it.
class Input
{
public:
  Input(const Points& points, const Triangles& triangles, const Fields& fields)
    : Vertices(points)
    , Faces(triangles)
    , Data(fields)
  {
    if (this->Data.HasCells() && this->Data.Cells.empty())
    {
      this->Data.Cells.resize(static_cast<std::size_t>(triangles.rows()));
      std::iota(this->Data.Cells.begin(), this->Data.Cells.end(), 0);
      this->Data.NumberOfCells = static_cast<Index>(triangles.rows());
    }
    Problems problems;
    const auto require = [&](const char* name, std::size_t rows, bool onCells)
    {
      const auto expected =
        onCells ? this->NumberOfCells() : static_cast<std::size_t>(points.rows());
      RequireRows(name, rows, expected, onCells, problems);
    };
    const auto rowsOf = [](const auto& matrix) { return static_cast<std::size_t>(matrix.rows()); };
    require("Data", rowsOf(fields.Data.Values), fields.Data.OnCells);
    if (fields.Samples)
    {
      RequireRows(
        "Samples", rowsOf(fields.Samples->Given), rowsOf(fields.Samples->Places), false, problems);
      RequireRows(
        "Weights", fields.Samples->Weights.size(), rowsOf(fields.Samples->Places), false, problems);
    }
    require("Missing", fields.Missing.size(), fields.Data.OnCells);
    require("Mask", fields.Mask.Values.size(), fields.Mask.OnCells);
    require("Fixed", fields.Fixed.Values.size(), fields.Fixed.OnCells);
    require(
      "FidelityFactors", fields.FidelityFactors.Values.size(), fields.FidelityFactors.OnCells);
    require("Seeds", fields.Seeds.Values.size(), fields.Seeds.OnCells);
    require("Speeds", fields.Speeds.Values.size(), fields.Speeds.OnCells);
    require("AlongSpeeds", fields.AlongSpeeds.Values.size(), fields.AlongSpeeds.OnCells);
    require("AcrossSpeeds", fields.AcrossSpeeds.Values.size(), fields.AcrossSpeeds.OnCells);
    require("StartTimes", fields.StartTimes.size(), false);
    require("SlopeErrors", rowsOf(fields.SlopeErrors), false);
    const auto faces = static_cast<std::size_t>(triangles.rows());
    RequireRows("Directions", rowsOf(fields.Directions.Values),
      fields.Directions.OnCells ? faces : static_cast<std::size_t>(points.rows()),
      fields.Directions.OnCells, problems);
    RequireRows("Rates", rowsOf(fields.Rates), faces, true, problems);
    RequireRows("Cells", this->Data.Cells.size(), faces, true, problems);
    if (faces == 0)
    {
      problems.emplace_back("the surface has 0 triangles; allowed: 1 or more");
    }
    if (fields.Rates.cols() != 0 && fields.Rates.cols() != 4)
    {
      problems.push_back(
        "Rates has " + std::to_string(fields.Rates.cols()) + " columns; allowed: 4");
    }
    for (const Index cell : this->Data.Cells)
    {
      if (cell < 0 || cell >= this->Data.NumberOfCells)
      {
        problems.push_back("Cells has the entry " + std::to_string(cell) +
          "; allowed: 0 or more and below NumberOfCells, " +
          std::to_string(this->Data.NumberOfCells));
        break;
      }
    }
    ThrowProblems(problems);
  }

  FieldSummary Summarize() const
  {
    FieldSummary summary;
    summary.Data = this->Data.Data.Values.size() > 0;
    summary.DataComponents = summary.Data ? static_cast<int>(this->Data.Data.Values.cols()) : 0;
    if (this->Data.Samples)
    {
      summary.Data = true;
      summary.DataComponents = static_cast<int>(this->Data.Samples->Given.cols());
    }
    summary.Directions = this->Data.Directions.Values.rows() > 0;
    summary.Fixed = !this->Data.Fixed.Values.empty();
    summary.Rates = this->Data.Rates.rows() > 0;
    summary.DataAreTerms = this->Data.DataAreTerms;
    summary.Sources = this->Data.Sources != nullptr;
    summary.PathPoints = this->Data.PathPoints != nullptr;
    summary.Speeds = !this->Data.Speeds.Values.empty();
    summary.AlongSpeeds = !this->Data.AlongSpeeds.Values.empty();
    summary.AcrossSpeeds = !this->Data.AcrossSpeeds.Values.empty();
    summary.StartTimes = !this->Data.StartTimes.empty();
    summary.SlopeErrorComponents = static_cast<int>(this->Data.SlopeErrors.cols());
    return summary;
  }

  /// excludes: triangles that the mask marks take no part.
  BlockInput Block(bool excludes) const
  {
    BlockInput block;
    block.ReadSurface = [this, excludes]
    {
      SurfaceArrays arrays{ this->Vertices, this->Faces, {} };
      if (excludes && !this->Data.Mask.OnCells)
      {
        arrays.Excluded = this->Data.Mask.Values;
      }
      else if (excludes && !this->Data.Mask.Values.empty())
      {
        for (const Index cell : this->Data.Cells)
        {
          arrays.ExcludedTriangles.push_back(
            this->Data.Mask.Values[static_cast<std::size_t>(cell)]);
        }
      }
      return arrays;
    };
    block.ReadFields = [this] { return this->Data; };
    return block;
  }

  void TakeOutputs(const OutputList& outputs, OutputSource& source, Solution& solution) const
  {
    source.NumberOfCells = static_cast<std::int64_t>(this->NumberOfCells());
    source.CellOf = [this](Index t) -> std::int64_t
    { return this->Data.Cells.empty() ? t : this->Data.Cells[static_cast<std::size_t>(t)]; };
    source.ReadData = [this] { return this->Data.Data.Values; };
    source.DataAreFloats = true;
    for (const Output& output : outputs)
    {
      switch (output.Where)
      {
        case Place::Number:
          solution.Numbers[output.Name] = output.Rows;
          break;
        case Place::Column:
        case Place::PerSample:
        case Place::PerCurvePoint:
          solution.Columns[output.Name] = output.Rows;
          break;
        case Place::PerCurve:
          if (output.Lines)
          {
            solution.Curves[output.Name] = output.Lines;
          }
          else
          {
            solution.Columns[output.Name] = output.Rows;
          }
          break;
        default:
          const bool isMain = output.IsState && output.IsResult;
          const bool isFirst = solution.Arrays.empty();
          const OutputRows rows(output, source);
          const Values& written = solution.Arrays[output.Name] = this->Write(rows, source);
          solution.Traits[output.Name] = { rows.OnCells(), output.IsResult || output.IsBesideResult,
            output.Active == Role::Coordinates };
          if (isFirst || isMain)
          {
            solution.Result = written;
          }
      }
    }
  }

private:
  std::size_t NumberOfCells() const
  {
    return this->Data.Cells.empty() ? static_cast<std::size_t>(this->Faces.rows())
                                    : static_cast<std::size_t>(this->Data.NumberOfCells);
  }

  Values Write(const OutputRows& rows, const OutputSource& source) const
  {
    Values written(rows.Count(), rows.Columns());
    rows.Write(
      written.data(), written.cols(), -1,
      [this](Index i, Eigen::Index k) { return this->Data.Data.Values(i, k); }, source.Parallel);
    return written;
  }

  const Points& Vertices;
  const Triangles& Faces;
  Fields Data;
};

std::vector<std::string> SentencesOf(const std::vector<Warning>& warnings)
{
  std::vector<std::string> sentences;
  for (const Warning& warning : warnings)
  {
    sentences.push_back(warning.Sentence.Text(NamesOfArrays));
  }
  return sentences;
}

/// find(run, input) of a DistanceRun, whose settings are checked together with the arrays.
template <typename Find>
void FindOnce(const Points& points, const Triangles& triangles, const SurfaceData& data,
  DistanceSettings& settings, const ParallelFor& parallel, const Find& find)
{
  WordErrors(
    [&]
    {
      const Input input(points, triangles, data);
      FieldSummary summary = input.Summarize();
      summary.Sources = true;
      Problems problems;
      settings.Check(&summary, problems);
      ThrowProblems(problems);
      DistanceRun run(parallel);
      NamingSettings(settings, [&] { find(run, input.Block(run.ExcludesMasked())); });
    });
}

/// A run without time steps, whose settings are checked together with the arrays.
Solution SolveOnce(std::unique_ptr<SurfaceRun> run, const Points& points,
  const Triangles& triangles, const SurfaceData& data, Settings& settings,
  const ParallelFor& parallel, const ProgressMonitor& progress = ProgressMonitor())
{
  return WordErrors(
    [&]
    {
      const Input input(points, triangles, data);
      const FieldSummary summary = input.Summarize();
      Problems problems;
      settings.Check(&summary, problems);
      ThrowProblems(problems);
      NamingSettings(
        settings, [&] { run->Update(input.Block(run->ExcludesMasked()), settings, progress); });
      if (const auto* const distance = dynamic_cast<const DistanceRun*>(run.get()))
      {
        DistanceRun::RequireSource({ distance });
      }
      Solution solution;
      OutputSource source{ run->GetSurface(), parallel };
      input.TakeOutputs(run->Outputs(), source, solution);
      solution.Warnings = SentencesOf(run->FindWarnings());
      if (const auto* const relief = dynamic_cast<const ReliefRun*>(run.get()))
      {
        solution.Traits["ReliefHeight"].IsOfData = false; // ResultArrayName has a default in VTK
        const std::vector<char>& turned = relief->TurnedTriangles();
        for (std::size_t t = 0; t < turned.size(); ++t)
        {
          if (turned[t])
          {
            solution.Turned.push_back(relief->GetSurface().InputTriangle(static_cast<Index>(t)));
          }
        }
      }
      return solution;
    });
}

Solution SolveSteps(const Input& input, const std::shared_ptr<RunSettings>& settings,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const FieldSummary summary = input.Summarize();
  Problems problems;
  settings->Check(&summary, problems);
  ThrowProblems(problems);

  Run run(parallel);
  int last = 0;
  NamingSettings(*settings,
    [&]
    {
      const bool excludes = settings->MaskMode == MaskMode::Exclude;
      run.Update(
        { input.Block(excludes) }, settings, Reduction::Serial(), progress.Part(0.0, 0.25));
      last = run.FindLastStep(progress.Part(0.25, 1.0));
      run.Seek(last, progress.Part(0.25, 1.0));
    });
  const Run::Block& block = run.GetBlock(0);
  Solution solution;
  OutputSource source{ *block.Surface, parallel };
  source.Block = &block;
  source.Traits = settings->DescribeModel();
  input.TakeOutputs(block.Outputs, source, solution);
  for (const auto& [name, number] : FindNumbers(run))
  {
    solution.Numbers[name] = number;
  }
  solution.Steps = run.MakeHistory(last);
  solution.Warnings = SentencesOf(run.FindWarnings(Reduction::Serial()));
  return solution;
}

} // namespace

const NamedSettings* FindModel(const std::string& function)
{
  for (const NamedSettings& model : SettingsOfModels)
  {
    if (function == model.Function)
    {
      return &model;
    }
  }
  return nullptr;
}

Solution SolveModel(const NamedSettings& model, const Points& points, const Triangles& triangles,
  const SurfaceData& data, std::unique_ptr<Settings> settings, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  if (model.MakeRun)
  {
    return SolveOnce(
      model.MakeRun(parallel), points, triangles, data, *settings, parallel, progress);
  }
  // The settings of a model without a run are RunSettings.
  std::shared_ptr<RunSettings> ofRun(static_cast<RunSettings*>(settings.release()));
  return SolveModel(points, triangles, data, std::move(ofRun), parallel, progress);
}

Solution SolveModel(const Points& points, const Triangles& triangles, const SurfaceData& data,
  std::shared_ptr<RunSettings> settings, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  return WordErrors(
    [&] { return SolveSteps(Input(points, triangles, data), settings, parallel, progress); });
}

Solution DirectionField(const Points& points, const Triangles& triangles,
  DirectionFieldSettings settings, const SurfaceData& data, const ParallelFor& parallel)
{
  return SolveOnce(
    std::make_unique<DirectionFieldRun>(parallel), points, triangles, data, settings, parallel);
}

Solution Curvature(const Points& points, const Triangles& triangles, CurvatureSettings settings,
  const SurfaceData& data, const ParallelFor& parallel)
{
  return SolveOnce(
    std::make_unique<CurvatureRun>(parallel), points, triangles, data, settings, parallel);
}

Solution RandomFields(const Points& points, const Triangles& triangles,
  RandomFieldSettings settings, const SurfaceData& data, const ParallelFor& parallel)
{
  return SolveOnce(
    std::make_unique<RandomFieldRun>(parallel), points, triangles, data, settings, parallel);
}

Solution Derivative(const Points& points, const Triangles& triangles, const SurfaceData& data,
  DerivativesSettings settings, const ParallelFor& parallel)
{
  return SolveOnce(
    std::make_unique<DerivativesRun>(parallel), points, triangles, data, settings, parallel);
}

Solution Distance(const Points& points, const Triangles& triangles, const SurfaceData& data,
  DistanceSettings settings, const ParallelFor& parallel)
{
  return SolveOnce(
    std::make_unique<DistanceRun>(parallel), points, triangles, data, settings, parallel);
}

SurfacePath ShortestPath(const Points& points, const Triangles& triangles,
  const std::vector<SurfacePlace>& places, bool isClosed, const SurfaceData& data,
  DistanceSettings settings, const ParallelFor& parallel)
{
  SurfacePath path;
  FindOnce(points, triangles, data, settings, parallel,
    [&](DistanceRun& run, const BlockInput& input)
    { path = run.FindPath(input, settings, places, isClosed, ProgressMonitor()); });
  return path;
}

SurfaceDisk DiskAround(const Points& points, const Triangles& triangles, const SurfacePlace& center,
  double radius, const SurfaceData& data, DistanceSettings settings, const ParallelFor& parallel)
{
  SurfaceDisk disk;
  FindOnce(points, triangles, data, settings, parallel,
    [&](DistanceRun& run, const BlockInput& input)
    { disk = run.FindDisk(input, settings, center, radius, ProgressMonitor()); });
  return disk;
}

SmoothnessEstimate EstimateFWHM(
  const Points& points, const Triangles& triangles, const Values& maps, bool subtractsMean)
{
  Problems problems;
  RequireRows("maps", static_cast<std::size_t>(maps.rows()),
    static_cast<std::size_t>(points.rows()), false, problems);
  ThrowProblems(problems);
  const TriangleMesh mesh(points, triangles);
  Values ofVertices(mesh.NumberOfVertices(), maps.cols());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    ofVertices.row(i) = maps.row(mesh.InputVertex()[i]);
  }
  NoiseWidth widths(mesh, subtractsMean);
  widths.Add(ofVertices);
  SmoothnessEstimate found{ widths.OfAll() * mesh.LengthUnit(), widths.OfColumns() };
  for (double& width : found.OfColumns)
  {
    width *= mesh.LengthUnit();
  }
  return found;
}

Values SmoothToFWHM(const Points& points, const Triangles& triangles, const Values& values,
  double fwhm, const Values& given, const ParallelFor& parallel)
{
  Values noise = given;
  if (noise.rows() == 0)
  {
    noise = values;
    noise.colwise() -=
      values.cols() > 1 ? Vector(values.rowwise().mean()) : Vector(Vector::Zero(values.rows()));
  }
  const auto smooth = [&](const Values& maps, double width)
  {
    HeatSettings settings;
    settings.Units = UnitsMode::Absolute;
    settings.TimeStep = width * width / (16.0 * std::log(2.0));
    settings.NumberOfTimeSteps = 1;
    settings.TimeIntegrator = TimeIntegrator::Exponential;
    settings.MassMatrix = MassMatrix::Mixed;
    return Heat(points, triangles, maps, settings, parallel).Result;
  };
  const double found = EstimateFWHM(points, triangles, noise).OfAll;
  const TriangleMesh mesh(points, triangles);
  WidthCorrection correction(
    fwhm, found, mesh.ControlAreas().sum() * mesh.LengthUnit() * mesh.LengthUnit());
  for (int trial = 0; trial < 40 && found < fwhm; ++trial)
  {
    const double width = correction.Width();
    const double reached = EstimateFWHM(points, triangles, smooth(noise, width)).OfAll;
    if (std::abs(reached / fwhm - 1.0) <= 0.005)
    {
      return smooth(values, width);
    }
    if (!correction.Take(reached))
    {
      break;
    }
  }
  throw std::runtime_error((Sentence("fwhm is ")
    << fwhm << ", but the noise has " << found << ", and smoothing reaches "
    << correction.LargestReached() << "; allowed: larger widths that are small against the surface")
                             .Text());
}

Solution DenoiseMesh(const Points& points, const Triangles& triangles,
  DenoisingRunSettings settings, const SurfaceData& data, const ParallelFor& parallel)
{
  Solution solution = SolveOnce(
    std::make_unique<DenoisingRun>(parallel), points, triangles, data, settings, parallel);
  if (solution.Arrays.count("Points") == 0) // nothing has moved
  {
    solution.Result = solution.Arrays["Points"] = points;
  }
  return solution;
}

} // namespace SurfaceDiffusion
