// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conservation.h"

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

} // namespace

double Total(
  const TriangleMesh& mesh, const Values& u, Eigen::Index k, const ParallelFor& parallel)
{
  return RangeTotal(mesh, u, k, 0, mesh.NumberOfVertices(), parallel);
}

Conservation::Conservation(const TriangleMesh& mesh, const PointData& data, bool hasFidelity,
  const ParallelFor& parallel)
{
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    bool conserves = true;
    for (Index i = begin; i < end && conserves; ++i)
    {
      conserves = !data.Fixed[i] &&
        !(hasFidelity && (data.Missing[i] || data.Given.row(i) != data.Start.row(i)));
    }
    if (conserves)
    {
      const double area = Sum(
        parallel, end - begin, [&](Index i) { return mesh.ControlAreas()[begin + i]; });
      this->Components.push_back({ begin, end, area });
    }
  }
  this->Targets.resize(static_cast<Eigen::Index>(this->Components.size()), data.Start.cols());
  for (Eigen::Index c = 0; c < this->Targets.rows(); ++c)
  {
    for (Eigen::Index k = 0; k < this->Targets.cols(); ++k)
    {
      this->Targets(c, k) = RangeTotal(
        mesh, data.Start, k, this->Components[c].Begin, this->Components[c].End, parallel);
    }
  }
}

void Conservation::Restore(
  const TriangleMesh& mesh, Values& u, const ParallelFor& parallel) const
{
  for (Eigen::Index c = 0; c < this->Targets.rows(); ++c)
  {
    const Component& component = this->Components[c];
    for (Eigen::Index k = 0; k < this->Targets.cols(); ++k)
    {
      const double left =
        this->Targets(c, k) - RangeTotal(mesh, u, k, component.Begin, component.End, parallel);
      const double shift = left / component.Area;
      ForEach(parallel, component.End - component.Begin,
        [&](Index i) { u(component.Begin + i, k) += shift; });
    }
  }
}

Balance::Balance(
  const TriangleMesh& mesh, Vector weights, const Flags& fixed, const ParallelFor& parallel)
  : Weights(std::move(weights))
{
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    if (!fixed.segment(begin, end - begin).any())
    {
      const double weight =
        Sum(parallel, end - begin, [&](Index i) { return this->Weights[begin + i]; });
      this->Components.push_back({ begin, end, weight });
    }
  }
}

void Balance::Restore(const Values& b, Values& x, const ParallelFor& parallel) const
{
  for (const Component& component : this->Components)
  {
    const Index begin = component.Begin;
    const Index count = component.End - begin;
    for (Eigen::Index k = 0; k < x.cols(); ++k)
    {
      const double left = Sum(parallel, count,
        [&](Index i) { return b(begin + i, k) - this->Weights[begin + i] * x(begin + i, k); });
      const double shift = left / component.Weight;
      ForEach(parallel, count, [&](Index i) { x(begin + i, k) += shift; });
    }
  }
}

} // namespace SurfaceDiffusion
