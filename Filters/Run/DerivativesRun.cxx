// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DerivativesRun.h"

#include "Core/Geometry/CellFits.h"
#include "Core/Geometry/HeatRegression.h"
#include "Core/Geometry/Helmholtz.h"
#include "Core/Vectors/TangentPlanes.h"
#include "Run/CellFields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// Columns that are smoothed together: four moments of each are kept.
constexpr Eigen::Index ColumnsAtOnce = 32;

/// Means over the corners of the triangles.
Values MeansOfCorners(const TriangleMesh& mesh, const Values& ofVertices)
{
  Values means(mesh.NumberOfTriangles(), ofVertices.cols());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = mesh.TriangleVertices().row(t);
    means.row(t) =
      (ofVertices.row(corners[0]) + ofVertices.row(corners[1]) + ofVertices.row(corners[2])) / 3.0;
  }
  return means;
}

} // namespace

void DerivativesSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice(
    { "Quantity", "",
      "What is computed: the Gradient of each component, a vector in the tangent "
      "plane; the Divergence or the Curl, its component along the normals, of "
      "vectors; the Laplacian of each component; the ConductionVelocity of "
      "arrival times T, grad T/|grad T|^2, with its length, the speed, and marks of "
      "collisions and foci, where it has no direction; or Helmholtz: "
      "the potentials of vectors and the parts that are a gradient, a curl, and neither." },
    this->Quantity,
    { "Gradient", "Divergence", "Curl", "Laplacian", "ConductionVelocity", "Helmholtz" });
  visitor.Number({ "SmoothingFWHM", "coordinates",
                   "Full width at half maximum of the Gaussian on the surface that smooths the "
                   "data first, in the unit of the coordinates: each value becomes that of the "
                   "linear function that fits the data near it. 0: none." },
    this->SmoothingFWHM, SettingRange::NonNegative());
  visitor.Switch({ "ResultOnCells", "",
                   "On: the result is on the cells. A gradient is then that of the linear function "
                   "on each triangle; other quantities are means of those at the points. Off: it "
                   "is on the points." },
    this->ResultOnCells);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void DerivativesSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  if (!fields)
  {
    return;
  }
  if (!fields->Data)
  {
    problems.push_back(Sentence(fields->DataName)
      << " is not set; allowed: an array on points or " << Word::Cells());
  }
  else if (this->TakesVectors() && fields->DataComponents % 3 != 0)
  {
    const char* const words[] = { "Gradient", "Divergence", "Curl", "Laplacian",
      "ConductionVelocity", "Helmholtz" };
    Sentence text(fields->DataName);
    text << " has " << fields->DataComponents << " components; allowed with "
         << Word::Setting("Quantity") << " "
         << Word::Choice("Quantity", this->Quantity, words[static_cast<int>(this->Quantity)])
         << ": 3, the vectors, or a multiple of 3";
    problems.push_back(text);
  }
  const Sentence name(Word::Array("SlopeErrorArray"));
  if (fields->SlopeErrorComponents == 0 || this->Quantity != DerivativeQuantity::ConductionVelocity)
  {
    return;
  }
  if (fields->Data && fields->SlopeErrorComponents != fields->DataComponents)
  {
    problems.push_back(Sentence(name)
      << " has " << fields->SlopeErrorComponents
      << " components; allowed: " << fields->DataComponents << ", as many as " << fields->DataName);
  }
  const Sentence together = Sentence(" together with ")
    << name << ", which is of times as they are";
  Require(!(this->SmoothingFWHM > 0.0), Word::Setting("SmoothingFWHM"), this->SmoothingFWHM,
    Sentence("0") << together, problems);
  Require(!this->ResultOnCells, Word::Setting("ResultOnCells"),
    Word::SwitchNumber(this->ResultOnCells),
    Sentence(Word::SwitchNumber(false)) << " together with " << name << ", which is of points",
    problems);
}

BlockInput DerivativesRun::WithoutMissing(const BlockInput& input)
{
  if (!this->IsMissingKnown || this->MissingVersion != input.FieldsVersion)
  {
    const Fields fields = input.ReadFields();
    const Values& values = fields.Data.Values;
    this->MissingRows.assign(static_cast<std::size_t>(values.rows()), 0);
    this->MissingOnCells = fields.Data.OnCells;
    bool isAny = false;
    for (Eigen::Index i = 0; i < values.rows(); ++i)
    {
      if (values.row(i).array().isInf().any())
      {
        throw ErrorAt(
          fields.DataName, "is infinite", fields.Data.OnCells, i, "allowed: finite values and NaN");
      }
      // What the mask leaves out does not matter.
      const bool isMasked =
        fields.Mask.OnCells == fields.Data.OnCells && IsSet(fields.Mask.Values, i);
      this->MissingRows[i] = !isMasked && values.row(i).hasNaN();
      isAny = isAny || this->MissingRows[i];
    }
    if (!isAny)
    {
      this->MissingRows.clear();
    }
    this->MissingVersion = input.FieldsVersion;
    this->IsMissingKnown = true;
  }
  BlockInput known = WithoutGivenAreas(input);
  if (!this->MissingRows.empty())
  {
    known.SurfaceVersion.Add(input.FieldsVersion);
    known.ReadSurface = [this, read = known.ReadSurface, fieldsOf = input.ReadFields]
    {
      SurfaceArrays arrays = read();
      if (!this->MissingOnCells)
      {
        arrays.Undetermined = this->MissingRows;
        return arrays;
      }
      const std::vector<Index> cells = fieldsOf().Cells;
      arrays.ExcludedTriangles.resize(cells.size(), 0);
      for (std::size_t t = 0; t < cells.size(); ++t)
      {
        if (this->MissingRows[cells[t]])
        {
          arrays.ExcludedTriangles[t] = 1;
        }
      }
      return arrays;
    };
  }
  return known;
}

void DerivativesRun::Update(
  const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DerivativesSettings&>(given);
  const BlockInput known = this->WithoutMissing(input);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  options.IntrinsicDelaunay = true; // of the smoothing: its weights are not negative
  if (!this->Prepare(known, settings, options, progress.Part(0.0, 0.3)))
  {
    return;
  }
  this->Results.clear();
  this->MissedResidual = 0.0;
  this->Undetermined = 0;
  this->NothingKnown = Sentence();
  this->OfTurns = Sentence();
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  const Points positions = VertexPositions(surface);
  const Fields fields = this->ReadFields(input);
  if (!this->MissingRows.empty() && surface.NumberOfTriangles() == 0)
  {
    this->NothingKnown << fields.DataName
                       << " is NaN in every triangle that takes part, and so is the result";
  }
  const Derivatives operators(mesh, positions, this->Parallel);
  this->Turned = operators.Normals().TurnedTriangles;
  progress.Report(0.35);
  const double unit = mesh.LengthUnit();
  const double fwhm = settings.SmoothingFWHM / unit;
  const bool isCurl = settings.Quantity == DerivativeQuantity::Curl;
  if (settings.TakesVectors() && fields.Data.OnCells && !(fwhm > 0.0))
  {
    Values ofTriangles(mesh.NumberOfTriangles(), fields.Data.Values.cols());
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      ofTriangles.row(t) =
        fields.Data.Values.row(fields.Cells[surface.InputTriangle(mesh.InputTriangle()[t])]);
    }
    if (settings.Quantity == DerivativeQuantity::Helmholtz)
    {
      this->AddParts(operators, ofTriangles, settings, progress.Part(0.35, 0.9));
    }
    else
    {
      const Values found = isCurl ? operators.Curl(ofTriangles) : operators.Divergence(ofTriangles);
      this->AddResult(isCurl ? "Curl" : "Divergence", found / unit, settings);
    }
  }
  else
  {
    const Values u =
      this->ReadAtVertices(fields, operators, positions, fwhm, progress.Part(0.35, 0.9));
    switch (settings.Quantity)
    {
      case DerivativeQuantity::Divergence:
        this->AddResult("Divergence", operators.DivergenceOfVertices(u) / unit, settings);
        break;
      case DerivativeQuantity::Curl:
        this->AddResult("Curl", operators.CurlOfVertices(u) / unit, settings);
        break;
      case DerivativeQuantity::Helmholtz:
      {
        const TangentPlanes planes(surface.SharedInputMesh(), positions, this->Parallel);
        const Values tangent = planes.Vectors(planes.Coordinates(u), Values());
        this->AddParts(
          operators, operators.ToTriangles(tangent), settings, progress.Part(0.6, 0.95));
        break;
      }
      case DerivativeQuantity::Laplacian:
      {
        const Values found = operators.Laplacian(u);
        this->Undetermined = static_cast<Index>((found.array() != found.array()).col(0).count());
        this->AddResult("Laplacian", found / unit / unit, settings);
        break;
      }
      default:
      {
        const Values ofTriangles = operators.Gradients(u) / unit;
        Values gradients = settings.ResultOnCells ? ofTriangles : operators.ToVertices(ofTriangles);
        if (settings.Quantity == DerivativeQuantity::Gradient)
        {
          this->Add("Gradient", std::move(gradients), settings.ResultOnCells);
          this->Results.back().Active = Role::Vectors;
        }
        else
        {
          const Values turns = this->FindTurns(operators, ofTriangles, settings.ResultOnCells);
          this->AddVelocity(std::move(gradients), turns, settings.ResultOnCells);
          if (fields.SlopeErrors.cols() > 0)
          {
            const Values speeds = this->Results[1].Rows;
            this->AddBand(speeds, fields.SlopeErrors);
          }
        }
      }
    }
  }
  this->Results.front().IsResult = true;
  progress.Report(1.0);
  this->Complete(input, settings);
}

Values DerivativesRun::ReadAtVertices(const Fields& fields, const Derivatives& operators,
  const Points& positions, double fwhm, const ProgressMonitor& progress)
{
  const Surface& surface = *this->Domain;
  Values u;
  if (fields.Data.OnCells)
  {
    u = FitCells(surface.InputMesh(), MakeCellTransfer(surface, fields, this->Parallel), positions,
      operators.Normals().OfVertices, fields.Data.Values, this->Parallel);
  }
  else
  {
    u = MakePointData(surface, fields, false, 1.0).Given;
  }
  for (Eigen::Index first = 0; fwhm > 0.0 && first < u.cols(); first += ColumnsAtOnce)
  {
    const Eigen::Index count = std::min(ColumnsAtOnce, u.cols() - first);
    const double columns = static_cast<double>(u.cols());
    const LinearFits fits = FitByHeat(
      *surface.SharedAssembler(), positions,
      [&](Index i, const Eigen::RowVectorXd&) -> Eigen::Vector3d
      { return operators.Normals().OfVertices.row(i).transpose(); },
      u.middleCols(first, count), fwhm, this->Parallel,
      progress.Part(first / columns, (first + count) / columns));
    u.middleCols(first, count) = fits.Constants;
    this->MissedResidual = std::max(this->MissedResidual, fits.MissedResidual);
  }
  return u;
}

void DerivativesRun::AddParts(const Derivatives& operators, const Values& ofTriangles,
  const DerivativesSettings& settings, const ProgressMonitor& progress)
{
  HelmholtzParts parts = DecomposeVectors(
    this->Domain->SharedInputMesh(), operators, ofTriangles, this->Parallel, progress);
  this->MissedResidual = std::max(this->MissedResidual, parts.MissedResidual);
  const double unit = this->Domain->InputMesh().LengthUnit();
  this->AddResult("GradientPotential", parts.GradientPotential * unit, settings);
  this->AddResult("CurlPotential", parts.CurlPotential * unit, settings);
  const auto add = [&](const char* name, const Values& part)
  {
    this->Add(
      name, settings.ResultOnCells ? part : operators.ToVertices(part), settings.ResultOnCells);
  };
  add("GradientPart", parts.GradientPart);
  add("CurlPart", parts.CurlPart);
  add("HarmonicPart", parts.HarmonicPart);
  for (std::size_t k = 1; k < this->Results.size(); ++k)
  {
    this->Results[k].IsBesideResult = true;
    this->Results[k].Active = Role::None;
  }
}

void DerivativesRun::AddResult(
  const char* name, Values ofVertices, const DerivativesSettings& settings)
{
  this->Add(name,
    settings.ResultOnCells ? MeansOfCorners(this->Domain->InputMesh(), ofVertices) : ofVertices,
    settings.ResultOnCells);
  this->Results.back().Active = Role::Scalars;
}

void DerivativesRun::Add(const char* name, Values rows, bool onTriangles)
{
  if (onTriangles)
  {
    this->Results.push_back({ name, Place::MeansOfTriangles, OutputType::Double, std::move(rows) });
    if (!this->MissingRows.empty())
    {
      this->Results.back().Elsewhere = Values::Constant(1, this->Results.back().Rows.cols(), NaN);
    }
    return;
  }
  const Surface& surface = *this->Domain;
  const auto count = static_cast<Index>(surface.Points().rows());
  Values ofPoints = Values::Zero(count, rows.cols());
  for (Index p = 0; p < count; ++p)
  {
    const Index vertex = surface.VertexOf(p);
    if (vertex >= 0)
    {
      ofPoints.row(p) = rows.row(vertex);
    }
    else if (!this->MissingRows.empty())
    {
      ofPoints.row(p).setConstant(NaN);
    }
  }
  this->Results.push_back({ name, Place::PerPoint, OutputType::Double, std::move(ofPoints) });
}

std::vector<Warning> DerivativesRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  AppendTurnedTriangles(this->Turned, warnings);
  AppendMissedResidual(this->MissedResidual, warnings);
  if (this->Undetermined > 0)
  {
    Sentence text;
    text
      << this->Undetermined
      << " boundary points have too few neighbours for second derivatives, and no Laplacian; use "
         "a finer surface";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  for (const Sentence& text : { this->NothingKnown, this->OfTurns })
  {
    if (!text.Words().empty())
    {
      warnings.push_back({ text, this->SurfaceVersion });
    }
  }
  return warnings;
}

} // namespace SurfaceDiffusion
