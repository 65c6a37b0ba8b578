// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/InitialState.h"

#include "Core/Foundation/Random.h"
#include "Core/Models/LinearDiffusion.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/AllComponents.h"

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
  void Reduce(const Reduction& reduction)
  {
    double sums[2] = { this->WeightedSum, this->Area };
    double bounds[2] = { -this->Low, this->High };
    reduction.Sum(sums, 2);
    reduction.Max(bounds, 2);
    *this = { sums[0], sums[1], -bounds[0], bounds[1] };
  }
  bool Empty() const { return !(this->Area > 0.0); }
  double Mean() const { return this->Empty() ? 0.0 : this->WeightedSum / this->Area; }
};

} // namespace

void FillMissing(const TriangleMesh& mesh, PointData& data, InitialFill fill, std::int64_t seed,
  const std::vector<std::int64_t>& ids)
{
  data.Start = data.Given;
  const Reduction& reduction = mesh.GetReduction();
  if (!reduction.Any(data.Missing.any()))
  {
    return;
  }
  const std::vector<Index> components = AllComponents(mesh);
  Values known(mesh.NumberOfComponents(), 2); // of a component: weighted sum, area
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    Statistics all;
    for (const Index c : components)
    {
      Statistics ofComponent;
      for (Index i = mesh.ComponentsBegin()[c]; i < mesh.ComponentsBegin()[c + 1]; ++i)
      {
        if (!data.Missing[i])
        {
          all.Add(mesh.ControlAreas()[i], data.Given(i, k));
          ofComponent.Add(mesh.ControlAreas()[i], data.Given(i, k));
        }
      }
      known(c, 0) = ofComponent.WeightedSum;
      known(c, 1) = ofComponent.Area;
    }
    all.Reduce(reduction);
    reduction.SumComponents(components, known);
    const double low = all.Empty() ? 0.0 : all.Low;
    const double high = all.Empty() ? 0.0 : all.High;
    for (const Index c : components)
    {
      const double mean = known(c, 1) > 0.0 ? known(c, 0) / known(c, 1) : all.Mean();
      for (Index i = mesh.ComponentsBegin()[c]; i < mesh.ComponentsBegin()[c + 1]; ++i)
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
        else if (fill != InitialFill::Input || std::isnan(start))
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

StepReport FillHarmonically(const std::shared_ptr<const Assembler>& assembler, PointData& data,
  const std::shared_ptr<LinearSolver>& solver, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  PointData known = PointData::FromValues(data.Start);
  known.Fixed = !data.Missing;
  LinearDiffusion::Settings settings;
  settings.TimeScheme = LinearDiffusion::Scheme::SteadyState;
  LinearDiffusion harmonic(assembler, CotanWeights(assembler->Mesh(), parallel), std::move(known),
    settings, solver, parallel);
  const StepReport report = harmonic.Advance(progress);
  for (Index i = 0; i < static_cast<Index>(data.Start.rows()); ++i)
  {
    if (data.Missing[i])
    {
      data.Start.row(i) = harmonic.State().row(i);
    }
  }
  return report;
}

void FixFreeComponents(const TriangleMesh& mesh, PointData& data, double fidelity)
{
  const std::vector<Index> components = AllComponents(mesh);
  const Eigen::Index columns = data.Start.cols();
  Values sums(mesh.NumberOfComponents(), columns + 2); // A u, A, whether bound
  for (const Index c : components)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    bool bound = false;
    for (Index i = begin; i < begin + size && !bound; ++i)
    {
      bound = data.Fixed[i] || fidelity * data.FidelityFactor(i) > 0.0;
    }
    const auto areas = mesh.ControlAreas().segment(begin, size);
    sums.row(c).head(columns) = areas.transpose() * data.Start.middleRows(begin, size);
    sums(c, columns) = areas.sum();
    sums(c, columns + 1) = bound ? 1.0 : 0.0;
  }
  mesh.GetReduction().SumComponents(components, sums);
  for (const Index c : components)
  {
    if (sums(c, columns + 1) == 0.0)
    {
      const Index begin = mesh.ComponentsBegin()[c];
      const Index size = mesh.ComponentsBegin()[c + 1] - begin;
      const Eigen::RowVectorXd mean = sums.row(c).head(columns) / sums(c, columns);
      data.Start.middleRows(begin, size).rowwise() = mean;
      data.Fixed.segment(begin, size) = true;
    }
  }
}

} // namespace SurfaceDiffusion
