// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/InterfaceReduction.h"

#include <cstddef>
#include <map>

namespace SurfaceDiffusion
{

namespace
{

/// The decomposition of a coarse level of multigrid, whose vertices are aggregates of vertices of a
/// finer one.
class CoarseDecomposition : public InterfaceReduction
{
public:
  /// finest: that of the surface. vertices: the exchange of `finer`. coarse, count: see
  /// Reduction::Coarsened().
  CoarseDecomposition(const Reduction& finest, const Reduction& finer,
    const InterfaceExchange& vertices, const std::vector<Index>& coarse, Index count)
    : InterfaceReduction(vertices)
    , OfSurface(finest)
  {
    const std::vector<Index>& fine = finer.InterfaceVertices();
    this->OwnedVertices.assign(count, true);
    std::map<Index, Index> numberOf; // on the interfaces, of coarse vertices
    std::vector<Index> coarseNumbers;
    for (std::size_t k = 0; k < fine.size(); ++k)
    {
      const Index vertex = coarse[fine[k]];
      if (vertex < 0)
      {
        coarseNumbers.push_back(vertex);
        continue;
      }
      const auto number = static_cast<Index>(this->VerticesOnInterface.size());
      const auto inserted = numberOf.emplace(vertex, number);
      if (inserted.second)
      {
        this->VerticesOnInterface.push_back(vertex);
        this->HolderSets.push_back(finer.InterfaceHolders()[k]);
        this->OwnedVertices[vertex] = finer.Owns(fine[k]);
      }
      coarseNumbers.push_back(inserted.first->second);
    }
    this->Vertices = vertices.Coarsened(coarseNumbers);
  }

  void Sum(double* numbers, Index count) const override { this->OfSurface.Sum(numbers, count); }
  void Max(double* numbers, Index count) const override { this->OfSurface.Max(numbers, count); }
  int Rank() const override { return this->OfSurface.Rank(); }
  std::vector<double> Gather(const std::vector<double>& here) const override
  {
    return this->OfSurface.Gather(here);
  }

protected:
  const Reduction& Finest() const override { return this->OfSurface; }

private:
  const Reduction& OfSurface;
};

} // namespace

std::shared_ptr<const Reduction> InterfaceReduction::Coarsened(
  const std::vector<Index>& coarse, Index count) const
{
  return std::make_shared<CoarseDecomposition>(
    this->Finest(), *this, this->Vertices, coarse, count);
}

} // namespace SurfaceDiffusion
