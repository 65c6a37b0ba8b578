// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/Assembler.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/IndexSet.h"
#include "Core/Operators/SparseProduct.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

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
  this->RowsBegin.assign(static_cast<std::size_t>(n) + 1, 0);
  this->SlotMap = Buffer<Slots>(corners.size());
  this->DiagonalSlots = Buffer<std::uint8_t>(static_cast<std::size_t>(n));
  ForEachBlock(parallel, n,
    [&](Index, Index first, Index last)
    {
      IndexSet row;
      std::vector<Index> slot; // of the numbers that the set gives
      std::vector<std::array<Index, 2>> numbers; // of the next and last vertex of each corner
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
        row.Rank(slot);
        this->RowsBegin[i + 1] = row.Size();
        // In long rows these are cut off, and not read.
        this->DiagonalSlots[i] = static_cast<std::uint8_t>(slot[0]);
        for (Index c = begin[i]; c < begin[i + 1]; ++c)
        {
          const auto [next, other] = numbers[c - begin[i]];
          this->SlotMap[c] = { static_cast<std::uint8_t>(slot[next]),
            static_cast<std::uint8_t>(slot[other]) };
        }
      }
    });
  progress.Report(0.9);
  std::partial_sum(this->RowsBegin.begin(), this->RowsBegin.end(), this->RowsBegin.begin());
  progress.Report(1.0);
}

/// The columns of all entries, sorted within each row.
void Assembler::ListColumns(Index* inner, const ParallelFor& parallel) const
{
  const TriangleMesh& m = *this->SurfaceMesh;
  const auto& begin = m.VertexCornersBegin();
  const auto& corners = m.VertexCorners();
  ForEach(parallel, m.NumberOfVertices(),
    [&](Index i)
    {
      Index* const row = inner + this->RowsBegin[i];
      if (this->IsMapped(i))
      {
        row[this->DiagonalSlots[i]] = i;
        for (Index c = begin[i]; c < begin[i + 1]; ++c)
        {
          row[this->SlotMap[c].Next] = m.OtherCorner(corners[c], 1);
          row[this->SlotMap[c].Last] = m.OtherCorner(corners[c], 2);
        }
        return;
      }
      std::vector<Index> columns = { i };
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        columns.push_back(m.OtherCorner(corners[c], 1));
        columns.push_back(m.OtherCorner(corners[c], 2));
      }
      std::sort(columns.begin(), columns.end());
      std::unique_copy(columns.begin(), columns.end(), row);
    });
}

SparsePattern Assembler::Pattern(const ParallelFor& parallel) const
{
  SparsePattern pattern;
  pattern.Outer = this->RowsBegin;
  pattern.Inner = Buffer<Index>(static_cast<std::size_t>(pattern.NumberOfEntries()));
  this->ListColumns(pattern.Inner.data(), parallel);
  return pattern;
}

void Assembler::TakePattern(SparseMatrix& matrix, const ParallelFor& parallel) const
{
  const Index n = this->SurfaceMesh->NumberOfVertices();
  matrix.resize(n, n);
  matrix.resizeNonZeros(this->RowsBegin[n]);
  ForEach(parallel, n + 1, [&](Index i) { matrix.outerIndexPtr()[i] = this->RowsBegin[i]; });
  this->ListColumns(matrix.innerIndexPtr(), parallel);
}

/// The place of the diagonal entry of a row, counted from its start.
Index Assembler::DiagonalSlot(Index row, const Index* inner) const
{
  const Index begin = this->RowsBegin[row];
  return this->IsMapped(row)
    ? Index{ this->DiagonalSlots[row] }
    : static_cast<Index>(
        std::lower_bound(inner + begin, inner + this->RowsBegin[row + 1], row) - inner) -
      begin;
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
      const Index diagonalSlot = outer[i] + this->DiagonalSlot(i, inner);
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
      const bool isMapped = this->IsMapped(i);
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
    [&](Index i)
    {
      const Index slot = this->DiagonalSlot(i, matrix.innerIndexPtr());
      matrix.valuePtr()[this->RowsBegin[i] + slot] = diagonal[i];
    });
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
        load.row(i) = a[outer[i] + this->DiagonalSlot(i, inner)] * values.row(i);
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
