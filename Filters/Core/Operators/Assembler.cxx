// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/Assembler.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/IndexSet.h"
#include "Core/Operators/SparseProduct.h"

#include <algorithm>
#include <array>

namespace SurfaceDiffusion
{

Assembler::Assembler(std::shared_ptr<const TriangleMesh> mesh, const ParallelFor& parallel,
  const ProgressMonitor& progress)
  : SurfaceMesh(std::move(mesh))
{
  const TriangleMesh& m = *this->SurfaceMesh;
  const Index n = m.NumberOfVertices();
  const auto& begin = m.VertexCornersBegin();
  const auto& corners = m.VertexCorners();

  // Rows are listed once. Their positions in the matrix are known when all rows are listed.
  std::vector<Index>& outer = this->Entries.Outer;
  outer.assign(static_cast<std::size_t>(n) + 1, 0);
  std::vector<std::vector<Index>> rows(NumberOfBlocks(n)); // one after another, per block
  this->SlotMap = Buffer<Slots>(corners.size());
  this->DiagonalSlot.resize(n);
  ForEachBlock(parallel, n,
    [&](Index block, Index first, Index last)
    {
      IndexSet row;
      std::vector<Index> slot; // of the numbers that the set gives
      std::vector<std::array<Index, 2>> numbers; // of the next and last vertex of each corner
      rows[block].reserve(8 * static_cast<std::size_t>(last - first));
      for (Index i = first; i < last; ++i)
      {
        row.Clear();
        row.Insert(i);
        numbers.resize(static_cast<std::size_t>(begin[i + 1] - begin[i]));
        for (Index c = begin[i]; c < begin[i + 1]; ++c) // most of these are new,
        {
          numbers[c - begin[i]][0] = row.Insert(m.OtherCorner(corners[c], 1));
        }
        for (Index c = begin[i]; c < begin[i + 1]; ++c) // most of these known
        {
          numbers[c - begin[i]][1] = row.Insert(m.OtherCorner(corners[c], 2));
        }
        const Index size = row.Size();
        row.Rank(slot);
        const std::size_t start = rows[block].size();
        rows[block].resize(start + size);
        for (Index k = 0; k < size; ++k)
        {
          rows[block][start + slot[k]] = row[k];
        }
        this->DiagonalSlot[i] = slot[0];
        for (Index c = begin[i]; c < begin[i + 1]; ++c)
        {
          const auto [next, other] = numbers[c - begin[i]];
          this->SlotMap[c] = { static_cast<std::uint8_t>(slot[next]),
            static_cast<std::uint8_t>(slot[other]) }; // not read in long rows
        }
        outer[i + 1] = size;
      }
    });
  progress.Report(0.7);
  for (Index i = 0; i < n; ++i)
  {
    outer[i + 1] += outer[i];
  }

  this->Entries.Inner = Buffer<Index>(static_cast<std::size_t>(outer[n]));
  ForEachBlock(parallel, n,
    [&](Index block, Index first, Index last)
    {
      std::copy(rows[block].begin(), rows[block].end(), this->Entries.Inner.data() + outer[first]);
      std::vector<Index>().swap(rows[block]);
      for (Index i = first; i < last; ++i)
      {
        this->DiagonalSlot[i] += outer[i];
      }
    });
  progress.Report(1.0);
}

void Assembler::Fill(SparseMatrix& matrix, const Eigen::Ref<const Vector>& diagonal, double scale,
  const CornerWeights& coefficients, const double* weights, const ParallelFor& parallel,
  const CornerWeights* signs) const
{
  const auto& begin = this->SurfaceMesh->VertexCornersBegin();
  const auto& corners = this->SurfaceMesh->VertexCorners();
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  double* values = matrix.valuePtr();
  ForEach(parallel, this->SurfaceMesh->NumberOfVertices(),
    [&](Index i)
    {
      std::fill(values + outer[i], values + outer[i + 1], 0.0);
      const Index diagonalSlot = this->DiagonalSlot[i];
      double onDiagonal = 0.0;
      const auto add = [&](Index slot, double coefficient, double sign)
      {
        if (slot == diagonalSlot)
        {
          // An edge from i to i, as in intrinsic triangulations, can have a coefficient so large
          // that adding and subtracting it would cancel all others.
          onDiagonal += (1.0 - sign) * coefficient;
          return;
        }
        values[slot] -= sign * coefficient;
        onDiagonal += coefficient;
      };
      const bool isMapped = outer[i + 1] - outer[i] <= LongestMappedRow;
      const auto slotOf = [&](Index corner, int further, std::uint8_t slot)
      {
        return isMapped
          ? outer[i] + slot
          : static_cast<Index>(std::lower_bound(inner + outer[i], inner + outer[i + 1],
                                 this->SurfaceMesh->OtherCorner(corner, further)) -
              inner);
      };
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        const Index t = corners[c] / 3;
        const int next = (corners[c] + 1) % 3; // 3 t + a: an edge is that opposite the third corner
        const int last = (corners[c] + 2) % 3;
        const double factor = weights ? scale * weights[t] : scale;
        add(slotOf(corners[c], 1, this->SlotMap[c].Next), factor * coefficients(t, last),
          signs ? (*signs)(t, last) : 1.0);
        add(slotOf(corners[c], 2, this->SlotMap[c].Last), factor * coefficients(t, next),
          signs ? (*signs)(t, next) : 1.0);
      }
      values[diagonalSlot] = diagonal[i] + onDiagonal;
    });
}

void Assembler::SetDiagonal(
  SparseMatrix& matrix, const Vector& diagonal, const ParallelFor& parallel) const
{
  ForEach(parallel, static_cast<Index>(diagonal.size()),
    [&](Index i) { matrix.valuePtr()[this->DiagonalSlot[i]] = diagonal[i]; });
}

void Assembler::Constrain(SparseMatrix& matrix, const Flags& fixed, const Values& values,
  Values& load, const ParallelFor& parallel) const
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  double* a = matrix.valuePtr();
  ForEach(parallel, this->SurfaceMesh->NumberOfVertices(),
    [&](Index i)
    {
      load.row(i).setZero();
      if (fixed[i])
      {
        load.row(i) = a[this->DiagonalSlot[i]] * values.row(i);
      }
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const Index j = inner[slot];
        if (j != i && (fixed[i] || fixed[j]))
        {
          if (!fixed[i])
          {
            load.row(i) -= a[slot] * values.row(j);
          }
          a[slot] = 0.0;
        }
      }
    });
}

void Multiply(const SparseMatrix& matrix, const Values& x, Values& y, const ParallelFor& parallel)
{
  ForEachBlock(parallel, static_cast<Index>(matrix.rows()),
    [&](Index, Index begin, Index end)
    {
      ForColumns(
        x.cols(), [&](auto columns) { MultiplyRows<columns()>(matrix, x, y, begin, end); });
    });
}

} // namespace SurfaceDiffusion
