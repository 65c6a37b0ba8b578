// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Operators/GradientMap.h"
#include "Core/Surface/TriangleMesh.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The passes of GradientSplitting over the triangles, with numbers in single or double precision.
/// Slices of 16 triangles are stored number by number, so that the lanes of a vector register
/// belong to 16 triangles.
///
/// p and b are kept as one vector w = r (p + b) per column: p is the proximal map of psi/r at p +
/// b, so that the multiplier is r b = share(|w|) w with share = 1 - shrinkage, for total variation
/// min(1, 1/|w|). Unlike p + b, w is of the size of psi' for data in any unit.
template <typename Number>
class SlicedSplitting
{
public:
  static constexpr Index Lanes = 16;

  SlicedSplitting(
    const EdgeFunction& function, ChannelCoupling coupling, const ParallelFor& parallel)
    : Function(function)
    , Coupling(coupling)
    , Parallel(parallel)
  {
  }

  /// penalty: r per triangle, times its area. All three must stay.
  void SetMesh(const TriangleMesh& mesh, const GradientMaps& gradients, const Vector& penalty);
  bool HasMesh() const { return this->IsComplete; }

  /// Whether the numbers of the mesh are far from the limits of Number.
  bool IsInRange() const;

  /// p = S grad u in the next Update(), and the first penalty. The multipliers are 0 unless they
  /// are kept.
  void Start(int columns, bool keepMultipliers);

  /// y, in row t of 2 columns numbers those of triangle t.
  void GetMultipliers(double* multipliers) const;
  void SetMultipliers(const double* multipliers); ///< only between Start() and Update()
  int NumberOfColumns() const { return this->Columns; }

  /// r over that of SetMesh(). A change leaves p and the multipliers.
  void SetGrowth(double growth);
  double Growth() const { return this->PenaltyGrowth; }

  /// Double or halve r on each triangle so that r |p| tends to a value that is best; for total
  /// variation. scales: r over that of before the first call, a power of two per triangle, which
  /// this updates. The multipliers stay. Does nothing before the first Update().
  void Balance(Vector& scales);
  /// The r of before the first Balance(), to the same bits, and scales of 1; before Start().
  void Unbalance(Vector& scales);

  /// p and b from u, over-relaxed, and A r (p - b) . S grad phi at the corners of the triangles.
  void Update(const Values& u, double relaxation);

  /// A y . S grad phi at the corners of the triangles.
  void SpreadMultipliers();

  /// row: at vertex i the sum of what Update() or SpreadMultipliers() left at the corners of its
  /// triangles; K columns, or any number of them for K = 0.
  template <int K>
  void Gather(Index i, double* row) const
  {
    const ColumnCount<K> columns(this->Columns);
    const std::vector<Index>& begin = this->Mesh->VertexCornersBegin();
    for (int k = 0; k < columns; ++k)
    {
      double sum = 0.0;
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        const auto place = static_cast<std::size_t>(this->Places[c]);
        const std::size_t lane = place % Lanes;
        sum += this->AtCorners[K == 1 ? place : (place - lane) * columns + k * Lanes + lane];
      }
      row[k] = sum;
    }
  }

  /// int psi*(|y|), summed over the triangles of this process.
  double ConjugateEnergy() const;

  struct Slice
  {
    Index Vertices[3][Lanes];
    Number Map[4][Lanes]; ///< x and y of r First and of r Second (GradientMap)
    Number AreaOverPenalty[Lanes]; ///< A / r
  };

private:
  /// Of component c, x or y of a column, and of a lane in W.
  std::size_t Place(Index s, int c, Index lane) const
  {
    return (static_cast<std::size_t>(s) * 2 * this->Columns + c) * Lanes + lane;
  }
  /// Those that are triangles.
  Index LanesOf(Index s) const
  {
    return std::min(Lanes, this->Mesh->NumberOfTriangles() - s * Lanes);
  }
  template <typename Act>
  void ForEachSlice(const Act& act) const;
  template <typename Act>
  void ForNorms(Index s, const Act& act) const;
  template <typename Factor>
  void Scale(const Factor& factor);
  void ScalePenalty(Index s, const Number (&factors)[Lanes], Vector& scales);
  void SetShares(Index s, const Number (&squares)[Lanes], Number (&shares)[Lanes]) const;

  const EdgeFunction Function;
  const ChannelCoupling Coupling;
  const ParallelFor& Parallel;
  const TriangleMesh* Mesh = nullptr;
  const Vector* Penalty = nullptr;
  std::vector<Index> Places; ///< (3 slice + corner) Lanes + lane of each of VertexCorners()
  Buffer<Slice> Slices;
  bool IsComplete = false; ///< the members above
  int Columns = 0;
  double PenaltyGrowth = 1.0;
  Buffer<Number> W; ///< per slice the lanes of x and of y of each column
  bool HasP = false; ///< W is r (p + b), and before the first Update() y
  Buffer<Number> AtCorners; ///< per slice and corner the lanes of each column
};

extern template class SlicedSplitting<float>;
extern template class SlicedSplitting<double>;

} // namespace SurfaceDiffusion
