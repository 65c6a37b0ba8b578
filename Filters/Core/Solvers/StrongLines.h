// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The preconditioner M of conjugate gradients for a symmetric positive definite matrix A: its
/// diagonal and its entries along lines of strongly connected vertices, which tridiagonal systems
/// solve exactly (linelets: O. Soto, R. Lohner, F. Camelli, Int. J. Numer. Methods Heat Fluid Flow
/// 13, 2003). On needles, where the diagonal alone needs more iterations the longer these are,
/// lines across them need those of an even mesh. Where no entry is strong, M is the diagonal.
///
/// An entry is strong if -a_ij > MinimumStrength min(a_ii, a_jj); on equilateral triangles it is a
/// sixth of them. Each vertex names its two strongest, or as many of them as are clearly stronger
/// than the others. Those that both ends name form lines and loops, as far as they are more than
/// MinimumShare of the diagonal at one of their ends. Positive entries of A are added to the
/// diagonal of M, so that M is positive definite. Over processes, lines do not touch interfaces.
///
/// M is scaled to the unit diagonal of A and factorised in double precision. The factors L D L^T
/// are stored in single precision; since D is positive, rounding leaves M positive definite.
class StrongLines
{
public:
  static constexpr double MinimumStrength = 0.27;
  static constexpr double MinimumShare = 0.83;
  static constexpr Index None = -1; ///< in place of a vertex

  explicit StrongLines(const ParallelFor& parallel)
    : Parallel(parallel)
  {
  }

  /// inverseDiagonal: that of the matrix, consistent over the processes. May throw Aborted; it has
  /// no lines then.
  void Set(const SparseMatrix& matrix, const Vector& inverseDiagonal,
    const Reduction& overProcesses = Reduction::Serial());

  /// The vertices on lines, line after line.
  const std::vector<Index>& Vertices() const { return this->Row; }
  bool IsEmpty() const { return this->Row.empty(); }
  /// Whether a process has any.
  bool IsEmptyEverywhere() const { return !this->IsAnywhere; }
  /// Per such vertex, the sum of its entries along lines over a_ii, in [0, 1].
  double Share(std::size_t place) const { return this->Shares[place]; }

  /// c = B r - r at the vertices on lines, where B = D^1/2 M^-1 D^1/2 with the diagonal D of A;
  /// elsewhere it is zero. rows: where r has each vertex on lines. Returns r . c, to the same bits
  /// on any number of threads.
  double Correct(const std::vector<Index>& rows, const float* r, float* c);

  /// z = M^-1 r, n x k
  void Precondition(const Vector& inverseDiagonal, const Values& r, Values& z) const;

private:
  using Pair = std::array<Index, 2>;
  struct StrongestEntries;
  struct LineRow;

  /// Longer lines are cut, for the sake of threads.
  static constexpr std::size_t LongestLine = 4096;
  static constexpr std::size_t TaskSize = 8192; ///< vertices of a task, at least
  /// Of the diagonal: what is left of it without the entries along a line. Where it is less,
  /// round-off of single precision would be taken for the mean of a needle's ends.
  static constexpr double SmallestExcess = 1e-6;

  void Reserve(std::size_t n);
  bool MayHaveLines(const SparseMatrix& matrix, const Vector& inverseDiagonal);
  bool MayBeOnLine(const SparseMatrix& matrix, Index i) const;
  void NameNeighbors(
    const SparseMatrix& matrix, const Vector& inverseDiagonal, const Reduction& overProcesses);
  bool AreMutual(Index i, int side) const;
  Pair Neighbors(Index i) const;
  void FindLines(Index n);
  void Factorize(const SparseMatrix& matrix, const Vector& inverseDiagonal);
  void FactorizeLine(const SparseMatrix& matrix, const Vector& inverseDiagonal, std::size_t line);
  void Clear();

  template <typename Number>
  void SolveLine(std::size_t line, Number* x) const;
  template <typename Act>
  void ForEachLine(const Act& act) const;

  const ParallelFor& Parallel;
  std::vector<Index> Row; ///< of the matrix
  std::vector<std::size_t> Begin; ///< of each line, and the end
  std::vector<char> IsLoop; ///< per line: whether its last vertex is connected with its first
  std::vector<std::size_t> Tasks; ///< the first line of each, and the end
  /// Per vertex on lines: D^-1 and, of its column of L, minus the entries of the next vertex and,
  /// in loops, of the last one.
  std::vector<float> InverseD, Next, Last;
  std::vector<float> Shares;
  std::vector<double> Sums; ///< of each task
  // Work, kept so that time steps do not allocate:
  std::vector<Pair> Named; ///< per vertex of the matrix
  std::vector<char> Pays; ///< whether the diagonal alone would be much worse
  std::vector<char> IsTaken;
  bool IsAnywhere = false;
};

} // namespace SurfaceDiffusion
