// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/CoarseDecomposition.h"

#include <cstddef>
#include <map>

namespace SurfaceDiffusion
{

CoarseDecomposition::CoarseDecomposition(const Reduction& finest, const Reduction& finer,
  const InterfaceExchange& vertices, const std::vector<Index>& coarse, Index count)
  : Reduction(Reduction::Kind::Distributed)
  , Finest(finest)
  , Vertices(vertices)
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

} // namespace SurfaceDiffusion
