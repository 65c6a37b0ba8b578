// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MeanCorrection.h"

#include "Core/Foundation/ColumnSums.h"
#include "Core/Surface/AllComponents.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Components of this mesh of which no process refuses its part.
template <typename Refuses>
std::vector<Index> Select(const TriangleMesh& mesh, const Refuses& refuses)
{
  std::vector<Index> all = AllComponents(mesh);
  Values refusals(mesh.NumberOfComponents(), 1);
  for (const Index c : all)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    refusals(c, 0) = refuses(begin, end) ? 1.0 : 0.0;
  }
  mesh.GetReduction().SumComponents(all, refusals);
  all.erase(std::remove_if(all.begin(), all.end(), [&](Index c) { return refusals(c, 0) > 0.0; }),
    all.end());
  return all;
}

/// One sum for each of the components, over the whole surface. sum(begin, end): over vertices.
template <typename SumOf>
std::vector<double> SumEach(
  const TriangleMesh& mesh, const std::vector<Index>& components, const SumOf& sum)
{
  Values sums(static_cast<Eigen::Index>(components.size()), 1);
  for (std::size_t c = 0; c < components.size(); ++c)
  {
    sums(static_cast<Eigen::Index>(c), 0) =
      sum(mesh.ComponentsBegin()[components[c]], mesh.ComponentsBegin()[components[c] + 1]);
  }
  mesh.GetReduction().SumComponents(components, sums);
  return std::vector<double>(sums.data(), sums.data() + sums.size());
}

/// From rows of some components to one row for each component of the mesh, zero for the others.
void Spread(
  const TriangleMesh& mesh, const std::vector<Index>& components, const Values& rows, Values& all)
{
  all.setZero(mesh.NumberOfComponents(), rows.cols());
  for (std::size_t c = 0; c < components.size(); ++c)
  {
    all.row(components[c]) = rows.row(static_cast<Eigen::Index>(c));
  }
}

/// Add shifts[k] to column k of u on a component.
void Shift(const TriangleMesh& mesh, Index component, const double* shifts, Values& u,
  const ParallelFor& parallel)
{
  const Index begin = mesh.ComponentsBegin()[component];
  ForColumns(u.cols(),
    [&](auto number)
    {
      const ColumnCount<decltype(number)::value> columns(u.cols());
      ForEach(parallel, mesh.ComponentsBegin()[component + 1] - begin,
        [&](Index i)
        {
          double* const row = &u(begin + i, 0);
          for (int k = 0; k < columns; ++k)
          {
            row[k] += shifts[k];
          }
        });
    });
}

void TotalColumns(
  const TriangleMesh& mesh, const Values& u, double* totals, const ParallelFor& parallel)
{
  SumColumns(
    parallel, mesh.NumberOfVertices(), u.cols(),
    [&](Index i, Eigen::Index k) { return mesh.ControlAreas()[i] * u(i, k); }, totals);
  mesh.GetReduction().Sum(totals, static_cast<Index>(u.cols()));
}

} // namespace

double Total(const TriangleMesh& mesh, const Values& u, Eigen::Index k, const ParallelFor& parallel)
{
  return mesh.GetReduction().Sum(Sum(
    parallel, mesh.NumberOfVertices(), [&](Index i) { return mesh.ControlAreas()[i] * u(i, k); }));
}

void Total(const TriangleMesh& mesh, const Values& u, std::vector<double>& totals,
  const ParallelFor& parallel)
{
  totals.resize(static_cast<std::size_t>(u.cols()));
  TotalColumns(mesh, u, totals.data(), parallel);
}

void FindMeans(
  const TriangleMesh& mesh, const Values& u, Eigen::RowVectorXd& means, const ParallelFor& parallel)
{
  means.resize(u.cols());
  TotalColumns(mesh, u, means.data(), parallel);
  const double area = mesh.GetReduction().Sum(mesh.ControlAreas().sum());
  for (double& mean : means)
  {
    mean = std::isfinite(mean / area) ? mean / area : 0.0;
  }
}

TotalCorrection::TotalCorrection(
  const TriangleMesh& mesh, const PointData& data, bool hasFidelity, const ParallelFor& parallel)
{
  this->Components = Select(mesh,
    [&](Index begin, Index end)
    {
      bool conserves = true;
      for (Index i = begin; i < end && conserves; ++i)
      {
        conserves = !data.Fixed[i] &&
          !(hasFidelity &&
            (data.Missing[i] || data.Given.row(i) != data.Start.row(i) ||
              data.FidelityFactor(i) != data.FidelityFactor(begin)));
      }
      return !conserves;
    });
  this->Areas = SumEach(mesh, this->Components,
    [&](Index begin, Index end) {
      return Sum(parallel, end - begin, [&](Index i) { return mesh.ControlAreas()[begin + i]; });
    });
  this->Totals.resize(static_cast<Eigen::Index>(this->Components.size()), data.Start.cols());
  this->SumComponents(mesh, data.Start, parallel);
  this->Targets = this->Totals;
}

void TotalCorrection::SumComponents(
  const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel)
{
  this->Totals.resize(static_cast<Eigen::Index>(this->Components.size()), u.cols());
  for (Eigen::Index c = 0; c < this->Totals.rows(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[this->Components[c]];
    const Index end = mesh.ComponentsBegin()[this->Components[c] + 1];
    SumColumns(
      parallel, end - begin, u.cols(),
      [&](Index i, Eigen::Index k) { return mesh.ControlAreas()[begin + i] * u(begin + i, k); },
      this->Totals.row(c).data());
  }
  mesh.GetReduction().SumComponents(this->Components, this->Totals);
}

/// Totals becomes the numbers to add.
void TotalCorrection::FindErrors(
  const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel, Eigen::Index first)
{
  this->SumComponents(mesh, u, parallel);
  for (Eigen::Index c = 0; c < this->Targets.rows(); ++c)
  {
    for (Eigen::Index k = 0; k < u.cols(); ++k)
    {
      double& shift = this->Totals(c, k);
      shift = (this->Targets(c, first + k) - shift) / this->Areas[c];
    }
  }
}

void TotalCorrection::Restore(
  const TriangleMesh& mesh, Values& u, const ParallelFor& parallel, Eigen::Index first)
{
  this->FindErrors(mesh, u, parallel, first);
  for (Eigen::Index c = 0; c < this->Targets.rows(); ++c)
  {
    Shift(mesh, this->Components[c], this->Totals.row(c).data(), u, parallel);
  }
}

void TotalCorrection::FindShifts(const TriangleMesh& mesh, const Values& u,
  const ParallelFor& parallel, Eigen::Index first, Values& shifts)
{
  this->FindErrors(mesh, u, parallel, first);
  Spread(mesh, this->Components, this->Totals, shifts);
}

MeanCorrection::MeanCorrection(
  const TriangleMesh& mesh, Vector weights, const Flags& fixed, const ParallelFor& parallel)
  : Weights(std::move(weights))
{
  this->Components =
    Select(mesh, [&](Index begin, Index end) { return fixed.segment(begin, end - begin).any(); });
  this->Sums = SumEach(mesh, this->Components,
    [&](Index begin, Index end)
    { return Sum(parallel, end - begin, [&](Index i) { return this->Weights[begin + i]; }); });
}

void MeanCorrection::FindMeans(
  const TriangleMesh& mesh, const Values& b, const Values& x, const ParallelFor& parallel)
{
  this->Residuals.resize(static_cast<Eigen::Index>(this->Components.size()), x.cols());
  for (Eigen::Index c = 0; c < this->Residuals.rows(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[this->Components[c]];
    const Index end = mesh.ComponentsBegin()[this->Components[c] + 1];
    SumColumns(
      parallel, end - begin, x.cols(),
      [&](Index i, Eigen::Index k)
      { return b(begin + i, k) - this->Weights[begin + i] * x(begin + i, k); },
      this->Residuals.row(c).data());
  }
  mesh.GetReduction().SumComponents(this->Components, this->Residuals);
  for (Eigen::Index c = 0; c < this->Residuals.rows(); ++c)
  {
    this->Residuals.row(c) /= this->Sums[c];
  }
}

void MeanCorrection::Restore(
  const TriangleMesh& mesh, const Values& b, Values& x, const ParallelFor& parallel)
{
  this->FindMeans(mesh, b, x, parallel);
  for (Eigen::Index c = 0; c < this->Residuals.rows(); ++c)
  {
    Shift(mesh, this->Components[c], this->Residuals.row(c).data(), x, parallel);
  }
}

void MeanCorrection::FindShifts(const TriangleMesh& mesh, const Values& b, const Values& x,
  const ParallelFor& parallel, Values& shifts)
{
  this->FindMeans(mesh, b, x, parallel);
  Spread(mesh, this->Components, this->Residuals, shifts);
}

} // namespace SurfaceDiffusion
