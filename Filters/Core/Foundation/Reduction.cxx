// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Reduction.h"

#include "Core/Foundation/Bisection.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// By bisection: no process needs the values of the others.
double DistributedQuantile(
  const Reduction& reduction, const Eigen::Ref<const Vector>& values, double fraction)
{
  const auto count = [&](const auto& counts)
  {
    return reduction.SumOverVertices(SerialFor(), static_cast<Index>(values.size()),
      [&](Index i) { return counts(values[i]) ? 1.0 : 0.0; });
  };
  const double all = count([](double) { return true; });
  if (all == 0.0)
  {
    return 0.0;
  }
  const auto rank = static_cast<double>(std::lround(fraction * (all - 1.0)));
  return SmallestReached(
    [&](double bound) { return count([bound](double x) { return x <= bound; }) > rank; });
}

} // namespace

const Reduction& Reduction::Serial()
{
  static const Reduction serial;
  return serial;
}

double Reduction::Quantile(const Eigen::Ref<const Vector>& values, double fraction) const
{
  Vector copy = values;
  return this->QuantileInPlace(copy, fraction);
}

double Reduction::QuantileInPlace(Vector& values, double fraction) const
{
  if (!this->IsSerial())
  {
    return DistributedQuantile(*this, values, fraction);
  }
  if (values.size() == 0)
  {
    return 0.0;
  }
  double* const begin = values.data();
  double* const at = begin + std::lround(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(begin, at, begin + values.size());
  return *at;
}

std::shared_ptr<const Reduction> Reduction::SharedSerial()
{
  return std::shared_ptr<const Reduction>(std::shared_ptr<void>(), &Reduction::Serial());
}

std::vector<char> Reduction::MarkInterfaces(Index count) const
{
  std::vector<char> marks(this->IsSerial() ? 0 : count, false);
  for (const Index vertex : this->VerticesOnInterface)
  {
    marks[vertex] = true;
  }
  return marks;
}

std::shared_ptr<const Reduction> Reduction::Coarsened(const std::vector<Index>&, Index) const
{
  return Reduction::SharedSerial();
}

namespace
{

/// change(rows) sees and changes the rows of the vertices alone.
template <typename Change>
void ChangeRows(
  const std::vector<Index>& vertices, double* rows, Index columns, const Change& change)
{
  std::vector<double> some(vertices.size() * columns);
  const auto row = [&](Index vertex)
  { return rows + static_cast<std::ptrdiff_t>(vertex) * columns; };
  double* numbers = some.data();
  for (const Index vertex : vertices)
  {
    numbers = std::copy_n(row(vertex), columns, numbers);
  }
  change(some.data());
  const double* changed = some.data();
  for (const Index vertex : vertices)
  {
    std::copy_n(changed, columns, row(vertex));
    changed += columns;
  }
}

} // namespace

void Reduction::UpdateFromOwners(double* rows, Index columns) const
{
  if (!this->IsSerial())
  {
    ChangeRows(this->VerticesOnInterface, rows, columns,
      [&](double* some) { this->UpdateInterface(some, columns); });
  }
}

void Reduction::Accumulate(double* rows, Index columns) const
{
  if (!this->IsSerial())
  {
    ChangeRows(this->VerticesOnInterface, rows, columns,
      [&](double* some) { this->AccumulateInterface(some, columns); });
  }
}

const Vector& Reduction::OwnedPart(const Vector& values, Vector& storage) const
{
  if (this->IsSerial())
  {
    return values;
  }
  storage = values;
  for (Eigen::Index i = 0; i < storage.size(); ++i)
  {
    storage[i] = this->Owns(static_cast<Index>(i)) ? storage[i] : 0.0;
  }
  return storage;
}

void Reduction::SumComponents(const std::vector<Index>& components, Values& sums) const
{
  if (this->IsSerial())
  {
    return;
  }
  Values all = Values::Zero(this->NumberOfComponents, sums.cols());
  for (std::size_t r = 0; r < components.size(); ++r)
  {
    all.row(this->SurfaceComponent[components[r]]) += sums.row(static_cast<Eigen::Index>(r));
  }
  this->Sum(all.data(), static_cast<Index>(all.size()));
  for (std::size_t r = 0; r < components.size(); ++r)
  {
    sums.row(static_cast<Eigen::Index>(r)) = all.row(this->SurfaceComponent[components[r]]);
  }
}

} // namespace SurfaceDiffusion
