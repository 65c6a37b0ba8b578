// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MeanCorrection.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

double RangeTotal(const TriangleMesh& mesh, const Values& u, Eigen::Index k, Index begin, Index end,
  const ParallelFor& parallel)
{
  return Sum(parallel, end - begin,
    [&](Index i) { return mesh.ControlAreas()[begin + i] * u(begin + i, k); });
}

/// Components of this mesh of which no process refuses its part.
template <typename Refuses>
std::vector<Index> Select(const TriangleMesh& mesh, const Refuses& refuses)
{
  std::vector<Index> all(mesh.NumberOfComponents());
  std::iota(all.begin(), all.end(), 0);
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

} // namespace

double Total(const TriangleMesh& mesh, const Values& u, Eigen::Index k, const ParallelFor& parallel)
{
  return mesh.GetReduction().Sum(RangeTotal(mesh, u, k, 0, mesh.NumberOfVertices(), parallel));
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
          !(hasFidelity && (data.Missing[i] || data.Given.row(i) != data.Start.row(i)));
      }
      return !conserves;
    });
  this->Areas = SumEach(mesh, this->Components,
    [&](Index begin, Index end) {
      return Sum(parallel, end - begin, [&](Index i) { return mesh.ControlAreas()[begin + i]; });
    });
  this->Totals.resize(static_cast<Eigen::Index>(this->Components.size()), data.Start.cols());
  this->Total(mesh, data.Start, parallel);
  this->Targets = this->Totals;
}

void TotalCorrection::Total(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel)
{
  for (Eigen::Index c = 0; c < this->Totals.rows(); ++c)
  {
    const Index component = this->Components[c];
    for (Eigen::Index k = 0; k < this->Totals.cols(); ++k)
    {
      this->Totals(c, k) = RangeTotal(mesh, u, k, mesh.ComponentsBegin()[component],
        mesh.ComponentsBegin()[component + 1], parallel);
    }
  }
  mesh.GetReduction().SumComponents(this->Components, this->Totals);
}

void TotalCorrection::Restore(const TriangleMesh& mesh, Values& u, const ParallelFor& parallel)
{
  this->Total(mesh, u, parallel);
  for (Eigen::Index c = 0; c < this->Targets.rows(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[this->Components[c]];
    const Index end = mesh.ComponentsBegin()[this->Components[c] + 1];
    for (Eigen::Index k = 0; k < this->Targets.cols(); ++k)
    {
      const double shift = (this->Targets(c, k) - this->Totals(c, k)) / this->Areas[c];
      ForEach(parallel, end - begin, [&](Index i) { u(begin + i, k) += shift; });
    }
  }
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

void MeanCorrection::Restore(
  const TriangleMesh& mesh, const Values& b, Values& x, const ParallelFor& parallel)
{
  this->Left.resize(static_cast<Eigen::Index>(this->Components.size()), x.cols());
  const auto forEach = [&](const auto& body)
  {
    for (Eigen::Index c = 0; c < this->Left.rows(); ++c)
    {
      const Index begin = mesh.ComponentsBegin()[this->Components[c]];
      for (Eigen::Index k = 0; k < x.cols(); ++k)
      {
        body(c, k, begin, mesh.ComponentsBegin()[this->Components[c] + 1] - begin);
      }
    }
  };
  forEach(
    [&](Eigen::Index c, Eigen::Index k, Index begin, Index count)
    {
      this->Left(c, k) = Sum(parallel, count,
        [&](Index i) { return b(begin + i, k) - this->Weights[begin + i] * x(begin + i, k); });
    });
  mesh.GetReduction().SumComponents(this->Components, this->Left);
  forEach(
    [&](Eigen::Index c, Eigen::Index k, Index begin, Index count)
    {
      const double shift = this->Left(c, k) / this->Sums[c];
      ForEach(parallel, count, [&](Index i) { x(begin + i, k) += shift; });
    });
}

} // namespace SurfaceDiffusion
