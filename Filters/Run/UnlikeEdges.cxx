// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/UnlikeEdges.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

Sentence SentenceOfUnlikeEdges(const TriangleMesh& mesh)
{
  Sentence text;
  if (mesh.NumberOfComponents() < 2 || !mesh.GetReduction().IsSerial())
  {
    return text;
  }
  const std::vector<Index>& begins = mesh.ComponentsBegin(); // of the vertices
  struct Edges
  {
    double Length = 0.0;
    Index Triangles = 0;
  };
  std::vector<Edges> components(begins.size() - 1);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto next = std::upper_bound(begins.begin(), begins.end(), mesh.TriangleVertices()(t, 0));
    Edges& component = components[static_cast<std::size_t>(next - begins.begin() - 1)];
    ++component.Triangles;
    for (int a = 0; a < 3; ++a)
    {
      component.Length += mesh.Shapes()[t].EdgeLength(a) / 3.0;
    }
  }
  constexpr double share = 0.01;
  constexpr double factor = 5.0;
  double smallest = 0.0;
  double largest = 0.0;
  for (const Edges& component : components)
  {
    if (component.Triangles >= share * mesh.NumberOfTriangles())
    {
      const double mean = component.Length / component.Triangles * mesh.LengthUnit();
      smallest = smallest > 0.0 ? std::min(smallest, mean) : mean;
      largest = std::max(largest, mean);
    }
  }
  if (largest > factor * smallest)
  {
    text << "the mean edge lengths of connected components go from " << smallest << " to "
         << largest << ", but lengths are in h, that of all, "
         << mesh.MeanEdgeLength() * mesh.LengthUnit()
         << " (process components of different size one by one)";
  }
  return text;
}

Sentence SentenceOfLongEdges(double count)
{
  Sentence text;
  if (count > 0.0)
  {
    text << count << (count == 1.0 ? " edge is" : " edges are")
         << " longer than 30 times the median edge and left out of the mean edge length h (if they "
            "belong to spikes, remove these points)";
  }
  return text;
}

} // namespace SurfaceDiffusion
