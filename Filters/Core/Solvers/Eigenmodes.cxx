// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Eigenmodes.h"

#include "Core/Solvers/ComponentModes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The rows and columns [begin, end) of a matrix, which has no entries beside them.
SparseMatrix DiagonalBlock(const SparseMatrix& matrix, Index begin, Index end)
{
  return matrix.block(begin, begin, end - begin, end - begin);
}

void FixSigns(const std::vector<Index>& inputVertex, Values& modes, const ParallelFor& parallel)
{
  const auto n = static_cast<Index>(modes.rows());
  ForEachTask(parallel, static_cast<Index>(modes.cols()),
    [&](Index k)
    {
      const double largest = n > 0 ? modes.col(k).cwiseAbs().maxCoeff() : 0.0;
      constexpr double nearly = 1.0 - 1e-6;
      Index first = -1;
      for (Index i = 0; i < n; ++i)
      {
        if (std::abs(modes(i, k)) >= nearly * largest &&
          (first < 0 || inputVertex[i] < inputVertex[first]))
        {
          first = i;
        }
      }
      if (first >= 0 && modes(first, k) < 0.0)
      {
        modes.col(k) *= -1.0;
      }
    });
}

} // namespace

Eigenmodes FindEigenmodes(const Assembler& assembler, const CornerWeights& coefficients,
  Index count, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const Index n = mesh.NumberOfVertices();
  SparseMatrix stiffness = ZeroMatrix(assembler.Pattern());
  assembler.Fill(stiffness, Vector::Zero(n), 1.0, coefficients, nullptr, parallel);

  struct Place
  {
    double Eigenvalue;
    Index Component, Column;
  };
  std::vector<Place> places;
  std::vector<Eigenmodes> found(static_cast<std::size_t>(mesh.NumberOfComponents()));
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    const auto& input = mesh.InputVertex();
    Eigenmodes& ofComponent = found[static_cast<std::size_t>(c)];
    ofComponent = FindComponentModes(DiagonalBlock(stiffness, begin, end),
      mesh.ControlAreas().segment(begin, end - begin),
      std::vector<Index>(input.begin() + begin, input.begin() + end), std::min(count, end - begin),
      parallel, progress.Part(static_cast<double>(begin) / n, static_cast<double>(end) / n));
    for (Index k = 0; k < static_cast<Index>(ofComponent.Eigenvalues.size()); ++k)
    {
      places.push_back({ ofComponent.Eigenvalues[k], c, k });
    }
  }
  std::stable_sort(places.begin(), places.end(),
    [](const Place& a, const Place& b) { return a.Eigenvalue < b.Eigenvalue; });
  places.resize(static_cast<std::size_t>(std::min(count, n)));
  Eigenmodes all{ Vector(places.size()), Values::Zero(n, static_cast<Index>(places.size())) };
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const auto [eigenvalue, c, column] = places[k];
    const Index begin = mesh.ComponentsBegin()[c];
    const auto at = static_cast<Eigen::Index>(k);
    all.Eigenvalues[at] = eigenvalue;
    all.Modes.col(at).segment(begin, mesh.ComponentsBegin()[c + 1] - begin) =
      found[static_cast<std::size_t>(c)].Modes.col(column);
  }
  FixSigns(mesh.InputVertex(), all.Modes, parallel);
  return all;
}

} // namespace SurfaceDiffusion
