// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "InitialState.h"

#include "Random.h"

#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// Area-weighted sum, area, smallest and largest of known values.
struct Statistics
{
  double WeightedSum = 0.0, Area = 0.0;
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();

  void Add(double area, double value)
  {
    this->WeightedSum += area * value;
    this->Area += area;
    this->Low = std::min(this->Low, value);
    this->High = std::max(this->High, value);
  }
  bool Empty() const { return !(this->Area > 0.0); }
  double Mean() const { return this->Empty() ? 0.0 : this->WeightedSum / this->Area; }
};

} // namespace

void FillMissing(const TriangleMesh& mesh, PointData& data, InitialFill fill, std::int64_t seed,
  const std::vector<std::int64_t>& ids)
{
  data.Start = data.Given;
  if (!data.Missing.any())
  {
    return;
  }
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    Statistics all;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (!data.Missing[i])
      {
        all.Add(mesh.ControlAreas()[i], data.Given(i, k));
      }
    }
    const double low = all.Empty() ? 0.0 : all.Low;
    const double high = all.Empty() ? 0.0 : all.High;
    for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
    {
      const Index begin = mesh.ComponentsBegin()[c];
      const Index end = mesh.ComponentsBegin()[c + 1];
      Statistics known;
      for (Index i = begin; i < end; ++i)
      {
        if (!data.Missing[i])
        {
          known.Add(mesh.ControlAreas()[i], data.Given(i, k));
        }
      }
      const double mean = known.Empty() ? all.Mean() : known.Mean();
      for (Index i = begin; i < end; ++i)
      {
        if (!data.Missing[i])
        {
          continue;
        }
        double& start = data.Start(i, k);
        if (fill == InitialFill::Noise)
        {
          const double random = UniformRandom(seed, k, ids[i]);
          start = (1.0 - random) * low + random * high;
        }
        else if (fill == InitialFill::Mean || std::isnan(start))
        {
          start = mean;
        }
        if (std::isnan(data.Given(i, k)))
        {
          data.Given(i, k) = start; // never read as data, but no NaN may enter an expression
        }
      }
    }
  }
}

void FixFreeComponents(const TriangleMesh& mesh, PointData& data, double fidelity)
{
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    bool held = false;
    for (Index i = begin; i < begin + size && !held; ++i)
    {
      held = data.Fixed[i] || (fidelity > 0.0 && !data.Missing[i]);
    }
    if (!held)
    {
      const auto areas = mesh.ControlAreas().segment(begin, size);
      auto start = data.Start.middleRows(begin, size);
      const Eigen::RowVectorXd mean = (areas.transpose() * start) / areas.sum();
      start.rowwise() = mean;
      data.Fixed.segment(begin, size) = true;
    }
  }
}

} // namespace SurfaceDiffusion
