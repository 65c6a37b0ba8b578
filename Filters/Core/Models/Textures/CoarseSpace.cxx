// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/CoarseSpace.h"

#include "Core/Foundation/Random.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/Aggregation.h"
#include "Core/Solvers/SparseColumns.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// k^2 times the mean area of a vertex, at most: at 3.4 vertices per wavelength on the first level,
/// a ninth of the vertices, on which patterns are recognisable, and at 6 on further ones, which
/// save less time.
constexpr double CoarsestWave = 3.0;
constexpr double CoarsestFurtherWave = 0.95;
/// Of the vertices of a level to those of the finer one: above it, coarsening saves too little.
constexpr double LargestRatio = 0.5;

/// The factor of k^2 in the coarse space; wave: k^2 times the mean area of the vertices. Lumped
/// linear elements with edges H on a regular triangulation have 1 - (k H)^2 / 16 = 1 - wave / 13.9.
/// Aggregates are irregular and softer. Fitted to waves on one and two levels over regular and
/// irregular triangulations.
double LumpedSymbol(double wave)
{
  return 1.0 - wave / 11.0;
}

/// The stiffness matrix K and the areas A of a level.
struct Level
{
  const SparseMatrix& Stiffness;
  const Vector& Areas;
};

/// Half the sums of the absolute entries of rows: the diagonal, but more beside obtuse angles, whose
/// negative weights make Jacobi sweeps with the diagonal grow.
Vector HalfRowSums(const SparseMatrix& stiffness, const ParallelFor& parallel)
{
  Vector sums(stiffness.cols());
  ForEach(parallel, static_cast<Index>(stiffness.cols()),
    [&](Index i)
    {
      double sum = 0.0;
      for (SparseMatrix::InnerIterator entry(stiffness, i); entry; ++entry)
      {
        sum += std::abs(entry.value());
      }
      sums[i] = 0.5 * sum;
    });
  return sums;
}

/// The quotient of v . K v on the coarser level and on the finer one for the restriction v of long
/// waves u, v . (P^T K u), without the effect of lumping. It is above 1, since linear functions are
/// not among the coarse ones. It is measured with noise that Jacobi sweeps have smoothed. The
/// symbol k^2 H^2 / 4 of diag(K)^-1 K gives the wave number.
double StiffnessExcess(const Level& fine, const Level& coarse, const SparseMatrix& restriction,
  const ParallelFor& parallel)
{
  constexpr int sweeps = 40;
  constexpr double damping = 0.9;
  const auto n = static_cast<Index>(fine.Areas.size());
  const Vector diagonal = HalfRowSums(fine.Stiffness, parallel);
  Values u(n, 1);
  Values product(n, 1);
  ForEach(parallel, n, [&](Index i) { u(i) = UniformRandom(0, 0, i); });
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    Multiply(fine.Stiffness, u, product, parallel);
    ForEach(parallel, n,
      [&](Index i) { u(i) -= diagonal[i] > 0.0 ? damping * product(i) / diagonal[i] : 0.0; });
  }
  u.array() -= fine.Areas.dot(u.col(0)) / fine.Areas.sum();
  Multiply(fine.Stiffness, u, product, parallel);
  const Vector weighted = fine.Areas.cwiseProduct(u.col(0));
  const Values v = Vector(restriction * weighted).cwiseQuotient(coarse.Areas);
  const double onFine = v.col(0).dot(restriction * product.col(0));
  product.resize(v.rows(), 1);
  Multiply(coarse.Stiffness, v, product, parallel);
  const double wave = onFine / coarse.Areas.dot(v.col(0).cwiseAbs2());
  const double symbol = wave * weighted.dot(u.col(0)) / diagonal.dot(u.col(0).cwiseAbs2());
  const double vertices = static_cast<double>(n) / static_cast<double>(coarse.Areas.size());
  const double excess =
    v.col(0).dot(product.col(0)) / onFine / LumpedSymbol(2.0 * std::sqrt(3.0) * symbol * vertices);
  return excess > 0.0 && std::isfinite(excess) ? excess : 1.0; // without any diffusion
}

/// The restriction of functions with the value 1 in mind: its columns sum to 1. A vertex that
/// aggregation leaves out becomes a coarse vertex of its own.
SparseMatrix NodalRestriction(
  const SparseMatrix& stiffness, double strength, const ParallelFor& parallel)
{
  Vector kernel = Vector::Ones(stiffness.rows());
  const SparseMatrix unit = SmoothedAggregation(stiffness, strength, kernel, parallel);
  std::vector<Index> own(static_cast<std::size_t>(unit.cols()), -1);
  Index count = static_cast<Index>(unit.rows());
  for (Index i = 0; i < unit.cols(); ++i)
  {
    if (unit.outerIndexPtr()[i] == unit.outerIndexPtr()[i + 1])
    {
      own[static_cast<std::size_t>(i)] = count++;
    }
  }
  return CollectColumns(count, static_cast<Index>(unit.cols()), parallel,
    [&](Index i, SparseColumn& column)
    {
      if (own[static_cast<std::size_t>(i)] >= 0)
      {
        column.Add(own[static_cast<std::size_t>(i)], 1.0);
      }
      for (SparseMatrix::InnerIterator w(unit, i); w; ++w)
      {
        column.Add(w.index(), w.value() * kernel[w.index()]);
      }
    });
}

/// Vertices with these areas, and no triangle.
std::shared_ptr<const Assembler> MakeVertices(const TriangleMesh& fine, Vector areas)
{
  TriangleMesh::Contents contents;
  contents.InputVertex.resize(static_cast<std::size_t>(areas.size()));
  std::iota(contents.InputVertex.begin(), contents.InputVertex.end(), 0);
  contents.ComponentsBegin = { 0, static_cast<Index>(areas.size()) };
  contents.LengthUnit = fine.LengthUnit();
  contents.ControlAreas = std::move(areas);
  return std::make_shared<Assembler>(std::make_shared<TriangleMesh>(std::move(contents)));
}

} // namespace

Values CoarseSpace::Restrict(const TriangleMesh& fine, const Values& u) const
{
  const Values weighted = fine.ControlAreas().asDiagonal() * u;
  return this->Assembly->Mesh().ControlAreas().cwiseInverse().asDiagonal() *
    Values(this->Restriction * weighted);
}

void CoarseSpace::Prolong(const Values& coarse, Values& u, const ParallelFor& parallel) const
{
  ForEach(parallel, static_cast<Index>(u.rows()),
    [&](Index i)
    {
      u.row(i).setZero();
      for (SparseMatrix::InnerIterator w(this->Restriction, i); w; ++w)
      {
        u.row(i) += w.value() * coarse.row(w.index());
      }
    });
}

std::optional<CoarseSpace> MakeCoarseSpace(const Assembler& fine,
  const std::array<CornerWeights, 2>& coefficients, double squaredWaveNumber,
  const ParallelFor& parallel)
{
  const TriangleMesh& mesh = fine.Mesh();
  const double whole = squaredWaveNumber *
    Sum(parallel, mesh.NumberOfVertices(), [&](Index i) { return mesh.ControlAreas()[i]; });
  CoarseSpace space;
  for (std::size_t c = 0; c < 2; ++c)
  {
    fine.TakePattern(space.Stiffness[c], parallel);
    fine.Fill(space.Stiffness[c], Vector::Zero(mesh.NumberOfVertices()), 1.0, coefficients[c],
      nullptr, parallel);
  }
  Vector areas = mesh.ControlAreas();
  double strength = 0.08; // as in Multigrid
  while (true)
  {
    const SparseMatrix restriction = NodalRestriction(space.Stiffness[1], strength, parallel);
    const auto count = static_cast<double>(restriction.rows());
    const double coarsest = space.Restriction.rows() > 0 ? CoarsestFurtherWave : CoarsestWave;
    if (whole > coarsest * count || count > LargestRatio * static_cast<double>(areas.size()))
    {
      break;
    }
    const SparseMatrix prolongation = Transposed(restriction, parallel);
    const Vector coarseAreas = restriction * areas;
    for (SparseMatrix& stiffness : space.Stiffness)
    {
      SparseMatrix coarse = GalerkinProduct(stiffness, restriction, prolongation, parallel);
      coarse /=
        StiffnessExcess({ stiffness, areas }, { coarse, coarseAreas }, restriction, parallel);
      stiffness.swap(coarse);
    }
    areas = coarseAreas;
    space.Restriction =
      space.Restriction.rows() > 0 ? SparseMatrix(restriction * space.Restriction) : restriction;
    strength *= 0.5;
  }
  if (space.Restriction.rows() == 0)
  {
    return std::nullopt;
  }
  const double symbol = LumpedSymbol(whole / static_cast<double>(areas.size()));
  for (SparseMatrix& stiffness : space.Stiffness)
  {
    stiffness /= symbol;
  }
  space.Assembly = MakeVertices(mesh, std::move(areas));
  return space;
}

} // namespace SurfaceDiffusion
