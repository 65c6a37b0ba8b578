// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothInterpolation.h"

#include "Core/Models/Interpolation/RangeConstraint.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Surface/ComponentMeshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The values of each component, with its own numbers of vertices. rows: those of all values that it has.
std::vector<RepeatedValues> ByComponent(
  const TriangleMesh& mesh, const RepeatedValues& all, std::vector<std::vector<Index>>& rows)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  std::vector<RepeatedValues> parts(static_cast<std::size_t>(mesh.NumberOfComponents()));
  rows.assign(parts.size(), {});
  for (Index i = 0; i < all.Count(); ++i)
  {
    SurfacePoint place = all.Places[i];
    std::size_t counting = 0;
    while (place.Coordinates[counting] == 0.0)
    {
      ++counting;
    }
    const Index vertex = place.Vertices[counting];
    const auto after = std::upper_bound(begin.begin(), begin.end(), vertex);
    const auto c = static_cast<std::size_t>(after - begin.begin()) - 1;
    for (std::size_t a = 0; a < 3; ++a)
    {
      place.Vertices[a] = (place.Coordinates[a] == 0.0 ? vertex : place.Vertices[a]) - begin[c];
    }
    parts[c].Places.push_back(place);
    rows[c].push_back(i);
  }
  for (std::size_t c = 0; c < rows.size(); ++c)
  {
    const Index count = parts[c].Count();
    parts[c].Given.resize(count, all.Given.cols());
    parts[c].Weights.resize(count);
    parts[c].Scatter.resize(count, all.Given.cols());
    parts[c].Repeats.resize(count);
    for (Index i = 0; i < count; ++i)
    {
      const Index row = rows[c][static_cast<std::size_t>(i)];
      parts[c].Given.row(i) = all.Given.row(row);
      parts[c].Weights[i] = all.Weights[row];
      parts[c].Scatter.row(i) = all.Scatter.row(row);
      parts[c].Repeats[i] = all.Repeats[row];
    }
  }
  return parts;
}

/// The numbers of a column over the components, from those of each with its values.
SmoothInterpolation::Column Together(const std::vector<SmoothInterpolation::Column>& parts,
  const std::vector<const RepeatedValues*>& values)
{
  if (parts.size() == 1)
  {
    return parts[0];
  }
  SmoothInterpolation::Column all;
  Index most = 0;
  double count = 0.0;
  double weight = 0.0;
  double free = 0.0;
  double noise = 0.0;
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    const SmoothInterpolation::Column& part = parts[c];
    const Index own = values[c]->Count();
    const double total = values[c]->Weights.sum();
    if (own > most)
    {
      most = own;
      all.Mu = part.Mu;
    }
    all.Score += own * part.Score;
    all.Residual += total * part.Residual * part.Residual;
    all.DegreesOfFreedom += part.DegreesOfFreedom;
    all.Energy += part.Energy;
    const double left =
      std::max(1e-6 * own, own + values[c]->Repeats.sum() - part.DegreesOfFreedom);
    free += part.NoiseLevel > 0.0 ? left : 0.0;
    noise += left * part.NoiseLevel * part.NoiseLevel;
    count += own;
    weight += total;
  }
  all.Score /= count;
  all.Residual = std::sqrt(all.Residual / weight);
  all.NoiseLevel = free > 0.0 ? std::sqrt(noise / free) : 0.0;
  return all;
}

} // namespace

SmoothInterpolation::SmoothInterpolation(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, const Settings& settings, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Options(settings)
  , Parallel(parallel)
{
}

SmoothInterpolation::Result SmoothInterpolation::Fit(
  const ScatteredValues& data, const ProgressMonitor& progress) const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index n = mesh.NumberOfVertices();
  const Eigen::Index columns = data.Given.cols();
  if (n == 0) // no triangle has an area
  {
    Result nothing;
    nothing.U.resize(0, columns);
    nothing.Columns.resize(static_cast<std::size_t>(columns));
    return nothing;
  }
  if (data.Count() == 0)
  {
    throw std::runtime_error("no value is known; allowed: one or more");
  }
  if (this->Options.Smoothing == Choice::Given && !(this->Options.Mu > 0.0))
  {
    throw std::invalid_argument("the given mu is not above 0");
  }
  if (this->Options.Smoothing == Choice::NoiseLevel && !(this->Options.NoiseLevel > 0.0))
  {
    throw std::invalid_argument("the given noise level is not above 0");
  }
  const MergedValues merged(data);
  Result result;
  result.RepeatedValues = merged.Repeated;
  result.ContradictingPlaces = merged.Contradicting;
  result.Columns.resize(static_cast<std::size_t>(columns));
  result.U = Values::Constant(n, columns, std::numeric_limits<double>::quiet_NaN());
  if (this->Options.ComputeError)
  {
    result.Error = result.SlopeError = result.U;
  }
  const Eigen::RowVectorXd lowest = merged.Rows.Given.colwise().minCoeff();
  const Eigen::RowVectorXd highest = merged.Rows.Given.colwise().maxCoeff();
  std::vector<std::vector<Index>> rowsOfParts;
  const std::vector<RepeatedValues> values = ByComponent(mesh, { data, merged }, rowsOfParts);
  Values leverage(this->Options.ComputeLeverage ? merged.Rows.Count() : 0, columns);
  const ComponentMeshes meshes(mesh);
  std::vector<const RepeatedValues*> valuesOfParts;
  std::vector<std::vector<Column>> columnsOfParts(result.Columns.size());
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const RepeatedValues& rows = values[static_cast<std::size_t>(c)];
    if (rows.Count() == 0)
    {
      ++result.UndeterminedComponents;
      continue;
    }
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    const ProgressMonitor ofPart =
      progress.Part(static_cast<double>(begin) / n, static_cast<double>(begin + size) / n);
    const Result part = size == n
      ? this->FitPart(rows, lowest, highest, ofPart)
      : this->OfComponent(meshes, c).FitPart(rows, lowest, highest, ofPart);
    result.U.middleRows(begin, size) = part.U;
    if (this->Options.ComputeError)
    {
      result.Error.middleRows(begin, size) = part.Error;
      result.SlopeError.middleRows(begin, size) = part.SlopeError;
    }
    for (Index i = 0; i < rows.Count() && this->Options.ComputeLeverage; ++i)
    {
      const std::vector<Index>& all = rowsOfParts[static_cast<std::size_t>(c)];
      leverage.row(all[static_cast<std::size_t>(i)]) = part.Leverage.row(i);
    }
    for (std::size_t column = 0; column < result.Columns.size(); ++column)
    {
      columnsOfParts[column].push_back(part.Columns[column]);
    }
    valuesOfParts.push_back(&rows);
    ++result.Parts;
    result.PartsWithTooFewValues += part.PartsWithTooFewValues;
    result.EnoughPlaces = std::max(result.EnoughPlaces, part.EnoughPlaces);
    result.HasUnknownError = result.HasUnknownError || part.HasUnknownError;
    result.HasInfiniteError = result.HasInfiniteError || part.HasInfiniteError;
    result.IsFlattest = result.IsFlattest || part.IsFlattest;
    result.DropsNegativeCurvature = result.DropsNegativeCurvature || part.DropsNegativeCurvature;
    result.RangeIsOptimal = result.RangeIsOptimal && part.RangeIsOptimal;
  }
  for (std::size_t column = 0; column < result.Columns.size(); ++column)
  {
    result.Columns[column] = Together(columnsOfParts[column], valuesOfParts);
  }
  result.Leverage.resize(this->Options.ComputeLeverage ? data.Count() : 0, columns);
  for (Index i = 0; i < static_cast<Index>(result.Leverage.rows()); ++i)
  {
    const Index row = merged.RowOf[static_cast<std::size_t>(i)];
    result.Leverage.row(i) = data.Weights[i] / merged.Rows.Weights[row] * leverage.row(row);
  }
  progress.Report(1.0);
  return result;
}

/// The same for a component of the surface.
SmoothInterpolation SmoothInterpolation::OfComponent(const ComponentMeshes& meshes, Index c) const
{
  const std::vector<Index> triangles = meshes.TrianglesOf(c);
  const auto count = static_cast<Index>(triangles.size());
  CornerWeights coefficients(count, 3);
  for (Index t = 0; t < count; ++t)
  {
    coefficients.row(t) = this->Coefficients.row(triangles[static_cast<std::size_t>(t)]);
  }
  // Loops over few triangles are not worth threads.
  const ParallelFor& parallel = count > BlockSize ? this->Parallel : SerialFor();
  return { std::make_shared<const Assembler>(meshes.Make(c), parallel), std::move(coefficients),
    this->Options, parallel };
}

SmoothInterpolation::Result SmoothInterpolation::FitPart(const RepeatedValues& rows,
  const Eigen::RowVectorXd& lowest, const Eigen::RowVectorXd& highest,
  const ProgressMonitor& progress) const
{
  const Index n = this->Assembly->Mesh().NumberOfVertices();
  const Eigen::Index columns = rows.Given.cols();
  Work work(*this->Assembly, this->Coefficients, this->Options, rows, this->Parallel);
  work.Lowest = lowest;
  work.Highest = highest;
  work.Start = Values::Zero(n, columns);
  Result result;
  result.Columns.resize(static_cast<std::size_t>(columns));
  result.Parts = 1;
  result.U.resize(n, columns);
  if (this->Options.ComputeError)
  {
    result.Error = Values::Zero(n, columns);
    result.SlopeError = Values::Constant(n, columns, std::numeric_limits<double>::quiet_NaN());
  }
  result.Leverage = Values::Ones(rows.Count(), columns); // of values that hold
  result.PartsWithTooFewValues =
    this->Options.Smoothing == Choice::Automatic && rows.Count() < result.EnoughPlaces ? 1 : 0;
  if (this->Options.Smoothing == Choice::Exact || result.PartsWithTooFewValues > 0)
  {
    this->FitExactly(work, result, progress);
  }
  else
  {
    this->FitSmoothly(work, result, progress);
  }
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    Column& found = result.Columns[static_cast<std::size_t>(c)];
    found.Energy = 0.5 * found.Mu * work.Energy.Squares(result.U.col(c))[0] +
      0.5 * work.TotalWeight * found.Residual * found.Residual;
  }
  result.U.rowwise() += work.Origin;
  for (Eigen::Index c = 0; c < columns && this->Options.KeepRange; ++c)
  {
    // To the last bit, which the origin rounds
    result.U.col(c) = result.U.col(c).cwiseMax(lowest[c]).cwiseMin(highest[c]);
  }
  return result;
}

void SmoothInterpolation::KeepInRange(Work& work, Result& result, Eigen::Index column,
  const Flags& held, Values& u, Values& forces, const ProgressMonitor& progress) const
{
  const double mu = work.Fit.GetSmoothing();
  const auto n = static_cast<Index>(u.rows());
  const double origin = work.Origin[column];
  const RangeConstraint range(work.Rows, column, this->Options.Smoothing == Choice::Exact,
    Vector::Constant(n, work.Lowest[column] - origin),
    Vector::Constant(n, work.Highest[column] - origin));
  const auto prepare = [&](const Flags& all, const ProgressMonitor& part)
  { this->Prepare(work, result, mu, all, part); };
  const bool isOptimal = range.Impose(work.Fit, prepare, held, u, forces, progress);
  result.RangeIsOptimal = result.RangeIsOptimal && isOptimal;
}

} // namespace SurfaceDiffusion
