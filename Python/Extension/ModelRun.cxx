// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ModelRun.h"

#include "Core/Models/TextureColors.h"
#include "PythonProgress.h"
#include "Run/CellDirections.h"
#include "Run/ConvertValue.h"
#include "Run/TextureSettings.h"
#include "SettingsTable.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

template <typename Matrix>
void WriteMatrix(const Matrix& from, const OutputArray& output)
{
  VisitElements(output,
    [&](auto* to)
    {
      using T = std::remove_pointer_t<decltype(to)>;
      WithValueErrors(
        [&]
        {
          std::transform(from.data(), from.data() + from.size(), to,
            [](double x) { return ConvertValue<T>(x); });
        });
    });
}

/// Row i becomes value(rowOf(i), k), or other(i, k) if rowOf(i) is negative and in further columns.
/// With first >= 0, only `components` columns from there on are written.
template <typename RowOf, typename Value, typename Other>
void WriteRows(const RowOf& rowOf, const OutputArray& output, Eigen::Index components,
  const Value& value, const Other& other, Eigen::Index first = -1)
{
  const auto stride = static_cast<Eigen::Index>(output.shape(1));
  const Eigen::Index columns = first < 0 ? stride : components;
  const Eigen::Index start = std::max<Eigen::Index>(first, 0);
  VisitElements(output,
    [&](auto* to)
    {
      using T = std::remove_pointer_t<decltype(to)>;
      const auto writeRow = [&](Index i)
      {
        const Index v = rowOf(i);
        T* const row = to + i * stride + start;
        const Eigen::Index known = v >= 0 ? std::min(components, columns) : 0;
        for (Eigen::Index k = 0; k < known; ++k)
        {
          row[k] = ConvertValue<T>(value(v, k));
        }
        for (Eigen::Index k = known; k < columns; ++k)
        {
          row[k] = ConvertValue<T>(other(i, k));
        }
      };
      WithValueErrors(
        [&] { ForEach(PythonThreads::Instance(), static_cast<Index>(output.shape(0)), writeRow); });
    });
}

/// Write value(v, k) at the points of vertices, and other(i, k) at all other points.
template <typename Value, typename Other>
void WritePoints(const Surface& surface, const OutputArray& output, Eigen::Index components,
  const Value& value, const Other& other, Eigen::Index first = -1)
{
  WriteRows([&](Index i) { return surface.VertexOf(i); }, output, components, value, other, first);
}

/// The same for faces: one row of `values` per face.
template <typename Other>
void WriteFaces(const CellTransfer& cells, const OutputArray& output, const Values& values,
  const Other& other, Eigen::Index first = -1)
{
  WriteRows([&](Index i) { return cells.Participates(i) ? i : -1; }, output, values.cols(),
    [&](Index i, Eigen::Index k) { return values(i, k); }, other, first);
}

constexpr double Opaque = 255.0;
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// 0, and opaque in the column of alpha.
auto NothingAt(Eigen::Index columns)
{
  return [columns](Index, Eigen::Index k) { return k < columns ? 0.0 : Opaque; };
}

template <typename T>
nb::list MakeList(const std::vector<StepRecord>& records, T StepRecord::*member)
{
  nb::list list;
  for (const StepRecord& record : records)
  {
    list.append(record.*member);
  }
  return list;
}

std::vector<std::string> SentencesOf(const std::vector<Warning>& warnings)
{
  std::vector<std::string> sentences;
  for (const Warning& warning : warnings)
  {
    sentences.push_back(warning.Sentence);
  }
  return sentences;
}

nb::list MakeList(const std::vector<double>& numbers)
{
  nb::list list;
  for (const double number : numbers)
  {
    list.append(number);
  }
  return list;
}

const TextureSettings& AsTexture(const RunSettings& settings)
{
  const auto* const texture = dynamic_cast<const TextureSettings*>(&settings);
  if (!texture)
  {
    throw nb::type_error("only turing_texture has a texture");
  }
  return *texture;
}

/// The units of the runs of later updates must not depend on a run that failed.
template <typename Work>
void ClearOnFailure(Run& run, Settings& settings, const Work& work)
{
  try
  {
    NamingExtremes(settings, work);
  }
  catch (const Aborted&)
  {
    throw; // a later update continues
  }
  catch (...)
  {
    run.Clear();
    throw;
  }
}

} // namespace

void ModelRun::Update(
  const nb::list& list, const nb::dict& settings, const nb::object& progress, bool history)
{
  std::vector<const InputFields*> blocks;
  for (const nb::handle& block : list)
  {
    blocks.push_back(nb::cast<const InputFields*>(block));
  }
  std::shared_ptr<RunSettings> own = MakeRunSettings(this->Name);
  AssignSettings(*own, settings);
  Problems problems;
  for (const InputFields* fields : blocks)
  {
    const FieldSummary summary = fields->Summarize();
    own->Check(&summary, problems);
  }
  ThrowProblems(std::move(problems));
  this->Settings = std::move(own);
  this->Model.SetKeepsHistory(history);

  const bool excludes = this->Settings->MaskMode == MaskMode::Exclude;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      std::vector<BlockInput> inputs(blocks.size());
      for (std::size_t b = 0; b < blocks.size(); ++b)
      {
        const InputFields& fields = *blocks[b];
        const auto excluded = excludes ? fields.Mask : std::nullopt;
        inputs[b].SurfaceVersion = fields.Surface->Version(excluded, fields.MaskOnFaces);
        inputs[b].FieldsVersion = fields.Version();
        inputs[b].ReadSurface = [&fields, excluded]
        { return fields.Surface->Read(excluded, fields.MaskOnFaces); };
        inputs[b].ReadFields = [&fields] { return fields.Read(); };
      }
      ClearOnFailure(this->Model, *this->Settings,
        [&] { this->Model.Update(inputs, this->Settings, this->Alone, monitor.Part(0.0, 0.25)); });
    });
}

void ModelRun::Seek(int step, const nb::object& progress)
{
  this->Step = step < 0 ? this->NumberOfSteps() : step;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      ClearOnFailure(this->Model, *this->Settings,
        [&] { this->Model.Seek(this->Step, monitor.Part(0.25, 1.0)); });
    });
}

std::vector<std::string> ModelRun::GetWarnings() const
{
  return SentencesOf(this->Model.FindWarnings(this->Alone));
}

nb::dict ModelRun::GetHistory() const
{
  const History history = this->Model.MakeHistory(this->Step);
  nb::dict columns;
  columns["Time"] = MakeList(history.Time);
  for (std::size_t k = 0; k < history.Totals.size(); ++k)
  {
    columns[("Total_" + std::to_string(k)).c_str()] = MakeList(history.Totals[k]);
  }
  columns["Energy"] = MakeList(history.Records, &StepRecord::Energy);
  columns["Iterations"] = MakeList(history.Records, &StepRecord::Iterations);
  columns["Residual"] = MakeList(history.Records, &StepRecord::Residual);
  columns["Seconds"] = MakeList(history.Records, &StepRecord::Seconds);
  if (history.CountsClamped)
  {
    columns["Clamped"] = MakeList(history.Records, &StepRecord::Clamped);
  }
  if (history.BoundsError)
  {
    columns["ErrorBound"] = MakeList(history.Records, &StepRecord::ErrorBound);
  }
  return columns;
}

nb::dict ModelRun::GetResults(std::size_t block) const
{
  const RunResult& result = this->Model.GetBlock(block).Result;
  nb::dict numbers;
  numbers["time_unit"] = this->Model.TimeUnit();
  numbers["mean_edge_length"] = this->Model.Units().MeanEdgeLength;
  numbers["value_range"] = this->Model.Units().ValueRange;
  numbers["number_of_unused_points"] =
    this->Model.GetBlock(block).Surface->Diagnostics().UnusedPoints;
  numbers["effective_fidelity_weight"] = result.EffectiveFidelityWeight;
  numbers["effective_edge_threshold"] = result.EffectiveEdgeThreshold;
  numbers["effective_smoothing_length"] = result.EffectiveSmoothingLength;
  numbers["estimated_noise_level"] = result.EstimatedNoiseLevel;
  numbers["wavelength"] = result.Wavelength;
  numbers["wavelength_growth_rate"] = result.WavelengthGrowthRate;
  numbers["diffusion_rate_factor"] = result.DiffusionRateFactor;
  numbers["coarse_start_vertices"] = result.CoarseStartVertices;
  numbers["mean_displacement"] = result.Motion.MeanDisplacement;
  numbers["maximum_displacement"] = result.Motion.MaximumDisplacement;
  numbers["volume_before"] = result.Motion.VolumeBefore;
  numbers["volume_after"] = result.Motion.VolumeAfter;
  return numbers;
}

void ModelRun::WriteState(std::size_t block, const OutputArray& output,
  const std::optional<InputArray>& source, int first, bool integers) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  const Values encoded =
    from.HasLinearLight ? from.EncodedState(PythonThreads::Instance()) : Values();
  const Values& state = from.HasLinearLight ? encoded : from.Path->State();
  const double unit = from.HasLinearLight ? 1.0 : from.Units.ValueUnit;
  const auto value = [&](Index v, Eigen::Index k) { return state(v, k) * unit; };
  const bool onFaces = this->HasResultOnFaces(block);
  const bool holdsNaN = !integers && this->Settings->DescribeModel().StateHasUnitOfValues &&
    output.dtype().code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float);
  const auto isNaN = [&](Index i) {
    return holdsNaN && (onFaces ? from.Cells->IsUndetermined(i) : from.Surface->IsUndetermined(i));
  };
  if (!source)
  {
    const auto nothing = [&, columns = state.cols()](Index i, Eigen::Index k) {
      return isNaN(i) ? NaN : k < columns ? 0.0 : Opaque;
    };
    if (onFaces)
    {
      WriteFaces(from.Cells->Transfer, output, from.Cells->Transfer.ToCells(state), nothing, first);
      return;
    }
    WritePoints(*from.Surface, output, state.cols(), value, nothing, first);
    return;
  }
  const auto columns = static_cast<Eigen::Index>(source->shape(1));
  if (onFaces)
  {
    VisitElements(*source,
      [&](const auto* old)
      {
        const Eigen::Index start = std::max(first, 0);
        Values given(static_cast<Eigen::Index>(source->shape(0)), state.cols());
        for (Eigen::Index i = 0; i < given.rows(); ++i)
        {
          for (Eigen::Index k = 0; k < given.cols(); ++k)
          {
            given(i, k) = static_cast<double>(old[i * columns + start + k]);
          }
        }
        const bool detail = this->Settings->DescribeModel().KeepCellDetail;
        WriteFaces(
          from.Cells->Transfer, output,
          from.CellResult(std::move(given), detail, PythonThreads::Instance()),
          [&](Index i, Eigen::Index k)
          { return isNaN(i) ? NaN : static_cast<double>(old[i * columns + start + k]); },
          first);
      });
    return;
  }
  VisitElements(*source,
    [&](const auto* old)
    {
      WritePoints(
        *from.Surface, output, state.cols(), value,
        [&](Index i, Eigen::Index k)
        { return isNaN(i) ? NaN : static_cast<double>(old[i * columns + std::max(first, 0) + k]); },
        first);
    });
}

void ModelRun::WriteColorsOfVectors(
  std::size_t block, const OutputArray& output, const InputFields& source) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  Fields colors;
  colors.Data = source.Read().Data;
  const bool onFaces = this->HasResultOnFaces(block);
  Values vectors = from.Path->State();
  Vector brightness = colors.Data.rowwise().norm();
  if (onFaces)
  {
    const bool detail = this->Settings->DescribeModel().KeepCellDetail;
    vectors = MakeCellResult(*from.Cells, vectors, colors.Data, detail);
  }
  else if (from.Cells)
  {
    brightness = Vector(
      from.Cells->Transfer.ToVertices(brightness, Vector::Ones(brightness.size())).Of.col(0));
  }
  else
  {
    brightness = MakePointData(*from.Surface, colors, false, 1.0).Given.rowwise().norm();
  }
  vectors.array().colwise() *= brightness.array();
  const auto value = [&](Index row, Eigen::Index k) { return vectors(row, k); };
  if (from.Cells && !onFaces)
  {
    WritePoints(*from.Surface, output, vectors.cols(), value, NothingAt(vectors.cols()));
    return;
  }
  const auto columns = static_cast<Eigen::Index>(source.Data->shape(1));
  VisitElements(*source.Data,
    [&](const auto* old)
    {
      const auto other = [&](Index i, Eigen::Index k)
      { return static_cast<double>(old[i * columns + k]); };
      if (onFaces)
      {
        WriteFaces(from.Cells->Transfer, output, vectors, other);
        return;
      }
      WritePoints(*from.Surface, output, vectors.cols(), value, other);
    });
}

bool ModelRun::HasResultOnFaces(std::size_t block) const
{
  return this->Model.GetBlock(block).Cells && this->Settings->DescribeModel().ResultOnCells;
}

void ModelRun::WriteTexture(std::size_t block, const OutputArray& output) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  const Vector texture = StretchContrast(
    from.Path->State().col(AsTexture(*this->Settings).TextureChemical), from.Result.ContrastLimits);
  WritePoints(
    *from.Surface, output, 1, [&](Index v, Eigen::Index) { return texture[v]; },
    [](Index, Eigen::Index) { return 0.0; });
}

void ModelRun::WriteTextureColors(std::size_t block, const OutputArray& output,
  const std::array<double, 3>& low, const std::array<double, 3>& high) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  const Vector texture = StretchContrast(
    from.Path->State().col(AsTexture(*this->Settings).TextureChemical), from.Result.ContrastLimits);
  const Colors colors = MixColors(texture, low, high);
  const Colors elsewhere = MixColors(Vector::Zero(1), low, high);
  WritePoints(
    *from.Surface, output, 3,
    [&](Index v, Eigen::Index k) { return static_cast<double>(colors(v, k)); },
    [&](Index, Eigen::Index k) { return static_cast<double>(elsewhere(0, k)); });
}

void ModelRun::WriteEdges(std::size_t block, const OutputArray& output) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  const Vector& edges = from.Result.Edges;
  if (this->HasResultOnFaces(block))
  {
    WriteFaces(from.Cells->Transfer, output, from.Cells->Transfer.ToCells(edges), NothingAt(1));
    return;
  }
  WritePoints(
    *from.Surface, output, 1, [&](Index v, Eigen::Index) { return edges[v]; },
    [](Index, Eigen::Index) { return 0.0; });
}

bool ModelRun::WriteAxes(
  std::size_t block, const InputSurface& surface, const OutputArray& output) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  if (from.Result.DiffusionAxes.rows() == 0)
  {
    return false;
  }
  const Points axes = DirectionsOfCells(
    *from.Surface, from.Result.DiffusionAxes, static_cast<std::int64_t>(surface.NumberOfFaces()),
    [&](Index t) { return surface.FaceOf(t); }, PythonThreads::Instance());
  WriteMatrix(axes, output);
  return true;
}

std::vector<Index> ModelRun::GetCurveSizes(std::size_t block) const
{
  const Polylines& curves = this->Model.GetBlock(block).Result.EdgeCurves;
  std::vector<Index> sizes;
  for (Index l = 0; l < curves.NumberOfLines(); ++l)
  {
    sizes.push_back(curves.Begin[l + 1] - curves.Begin[l]);
  }
  return sizes;
}

void ModelRun::WriteCurves(std::size_t block, const OutputArray& output) const
{
  WriteMatrix(this->Model.GetBlock(block).Result.EdgeCurves.Points, output);
}

nb::dict ModelRun::GetRegions(std::size_t block) const
{
  const RegionResults& found = *this->Model.GetBlock(block).Result.Regions;
  const auto rowsOf = [](const auto& matrix)
  {
    std::vector<std::vector<double>> rows;
    for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    {
      rows.emplace_back(matrix.row(r).data(), matrix.row(r).data() + matrix.cols());
    }
    return rows;
  };
  nb::dict regions;
  regions["means"] = nb::cast(rowsOf(found.Means));
  regions["areas"] =
    nb::cast(std::vector<double>(found.Areas.data(), found.Areas.data() + found.Areas.size()));
  regions["boundary_lengths"] = nb::cast(std::vector<double>(
    found.BoundaryLengths.data(), found.BoundaryLengths.data() + found.BoundaryLengths.size()));
  regions["components"] = nb::cast(found.Components);
  regions["gap"] = found.Gap;
  regions["label_gap"] = found.LabelGap;
  regions["number_of_alternations"] = found.NumberOfAlternations;
  regions["points"] = nb::cast(rowsOf(found.Boundaries.Points));
  nb::list curves;
  for (const RegionBoundary& curve : found.Boundaries.Curves)
  {
    curves.append(
      nb::make_tuple(curve.Regions[0], curve.Regions[1], curve.Length, nb::cast(curve.Points)));
  }
  regions["curves"] = curves;
  return regions;
}

void ModelRun::WriteLabels(std::size_t block, const OutputArray& output) const
{
  const Run::Block& from = this->Model.GetBlock(block);
  if (this->HasResultOnFaces(block))
  {
    const std::vector<Index> ofFaces = MakeCellLabels(*from.Cells, from.Path->State());
    const Values values =
      Eigen::Map<const Eigen::VectorXi>(ofFaces.data(), static_cast<Eigen::Index>(ofFaces.size()))
        .cast<double>();
    WriteFaces(from.Cells->Transfer, output, values, NothingAt(1));
    return;
  }
  const std::vector<Index>& labels = from.Result.Regions->Labels;
  WritePoints(
    *from.Surface, output, 1,
    [&](Index v, Eigen::Index) { return static_cast<double>(labels[static_cast<std::size_t>(v)]); },
    [](Index, Eigen::Index) { return 0.0; });
}

bool ModelRun::WriteMovedPoints(std::size_t block, const OutputArray& output) const
{
  const Points& moved = this->Model.GetBlock(block).Result.MovedPoints;
  if (moved.rows() == 0)
  {
    return false;
  }
  VisitElements(output,
    [&](auto* to)
    {
      using T = std::remove_pointer_t<decltype(to)>;
      std::transform(
        moved.data(), moved.data() + moved.size(), to, [](double x) { return ConvertValue<T>(x); });
    });
  return true;
}

//------------------------------------------------------------------------------------------------
namespace
{

/// `input` without a mask, for as long as it lives.
BlockInput MakeUnmaskedBlock(const InputFields& input)
{
  BlockInput block;
  block.SurfaceVersion = input.Surface->Version(std::nullopt, false);
  block.FieldsVersion = input.Version();
  block.ReadSurface = [&] { return input.Surface->Read(std::nullopt, false); };
  block.ReadFields = [&] { return input.Read(); };
  return block;
}

void AppendDegenerateTriangles(
  std::vector<std::string>& sentences, const Surface& surface, const std::string& consequence)
{
  const Index degenerate = surface.Diagnostics().DegenerateTriangles;
  if (degenerate > 0)
  {
    sentences.push_back(std::to_string(degenerate) + " triangles of zero area " + consequence);
  }
}

} // namespace

void DirectionRun::Update(
  const InputFields& input, const nb::dict& values, const nb::object& progress)
{
  DirectionFieldSettings settings;
  AssignSettings(settings, values);
  const FieldSummary summary = input.Summarize();
  Problems problems;
  settings.Check(&summary, problems);
  ThrowProblems(std::move(problems));
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      NamingExtremes(
        settings, [&] { this->Field.Update(MakeUnmaskedBlock(input), settings, monitor); });
    });
}

std::vector<std::string> DirectionRun::GetWarnings() const
{
  std::vector<std::string> sentences = SentencesOf(this->Field.FindWarnings());
  AppendDegenerateTriangles(sentences, this->Field.GetSurface(), "get no direction");
  return sentences;
}

void DirectionRun::Write(const InputSurface& surface, const OutputArray& output) const
{
  const Points directions = DirectionsOfCells(
    this->Field.GetSurface(), this->Field.Directions(),
    static_cast<std::int64_t>(surface.NumberOfFaces()), [&](Index t) { return surface.FaceOf(t); },
    PythonThreads::Instance());
  WriteMatrix(directions, output);
}

//------------------------------------------------------------------------------------------------
void MeshDenoiser::Update(
  const InputFields& input, const nb::dict& values, const nb::object& progress)
{
  DenoisingRunSettings settings;
  AssignSettings(settings, values);
  Problems problems;
  CheckRanges(settings, problems);
  ThrowProblems(std::move(problems));
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      NamingExtremes(
        settings, [&] { this->Run.Update(MakeUnmaskedBlock(input), settings, monitor); });
    });
}

nb::dict MeshDenoiser::GetResults() const
{
  const DenoisingReport& report = this->Run.Report();
  nb::dict results;
  results["noise_level"] = report.NoiseLevel;
  results["surface_type"] = this->Run.FoundType() == SurfaceType::CAD ? "CAD" : "Organic";
  results["mean_displacement"] = report.MeanDisplacement;
  results["maximum_displacement"] = report.MaximumDisplacement;
  results["volume_before"] = this->Run.VolumeBefore();
  results["volume_after"] = this->Run.VolumeAfter();
  results["mean_edge_length"] = this->Run.MeanEdgeLength();
  return results;
}

std::vector<std::string> MeshDenoiser::GetWarnings() const
{
  std::vector<std::string> sentences = SentencesOf(this->Run.FindWarnings());
  AppendDegenerateTriangles(sentences, this->Run.GetSurface(), "have no normal");
  return sentences;
}

void MeshDenoiser::Write(const OutputArray& output) const
{
  WriteMatrix(this->Run.MovedPoints(), output);
}

} // namespace SurfaceDiffusion
