// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Grid.h"

#include <chrono>
#include <cmath>
#include <cstring>

namespace SurfaceDiffusion::Gpu
{

namespace
{

// --- Matrices ---

struct FillArguments
{
  int Rows;
  const int* Outer;
  const int* Inner;
  const double* Values;
  double* Roots; ///< or null
  int* Columns;
  int* LongColumns;
  Slices To;
};

__global__ void __launch_bounds__(Threads) TakeDiagonal(FillArguments a)
{
  ForEach(a.Rows,
    [&](int i)
    {
      for (int slot = a.Outer[i]; slot < a.Outer[i + 1]; ++slot)
      {
        if (a.Inner[slot] == i)
        {
          a.Roots[i] = 1.0 / sqrt(a.Values[slot]);
        }
      }
    });
}

__device__ inline void Put(const FillArguments& a, int i, int slot, int at, bool isLong)
{
  const int j = a.Inner[slot];
  const double value = a.Values[slot] * (a.Roots ? a.Roots[i] * a.Roots[j] : 1.0);
  (isLong ? a.LongColumns : a.Columns)[at] = j;
  (isLong ? a.To.LongSingles : a.To.Singles)[at] = static_cast<float>(value);
  if (a.To.Doubles)
  {
    (isLong ? a.To.LongDoubles : a.To.Doubles)[at] = value;
  }
}

__global__ void __launch_bounds__(Threads) Fill(FillArguments a)
{
  ForEach(a.Rows,
    [&](int i)
    {
      const int end = a.To.Begin[i / Lanes + 1];
      int at = a.To.Begin[i / Lanes] + i % Lanes;
      if (a.To.LongRows == 0 || !a.To.IsLong[i])
      {
        for (int slot = a.Outer[i]; slot < a.Outer[i + 1]; ++slot)
        {
          if (!a.To.HasUnitDiagonal || a.Inner[slot] != i)
          {
            Put(a, i, slot, at, false);
            at += Lanes;
          }
        }
      }
      for (; at < end; at += Lanes)
      {
        a.Columns[at] = a.To.HasUnitDiagonal ? i : 0; // any column that exists
        a.To.Singles[at] = 0.0F;
        if (a.To.Doubles)
        {
          a.To.Doubles[at] = 0.0;
        }
      }
    });
  ForEach(a.To.LongRows,
    [&](int l)
    {
      const int i = a.To.LongRow[l];
      int at = a.To.LongBegin[l];
      for (int slot = a.Outer[i]; slot < a.Outer[i + 1]; ++slot)
      {
        if (!a.To.HasUnitDiagonal || a.Inner[slot] != i)
        {
          Put(a, i, slot, at++, true);
        }
      }
    });
}

} // namespace

DeviceRows::DeviceRows(const HostRows& rows, bool hasUnitDiagonal, double* roots, bool hasDoubles)
  : View()
{
  const int n = rows.Count;
  const auto entries = static_cast<std::size_t>(rows.Outer[n]);
  const auto slices = static_cast<std::size_t>((n + Lanes - 1) / Lanes);
  std::vector<int> begin(slices + 1, 0);
  std::vector<int> longRow;
  std::vector<int> longBegin = { 0 };
  for (std::size_t s = 0; s < slices; ++s)
  {
    int longest = 0;
    const int last = std::min(n, static_cast<int>(s + 1) * Lanes);
    for (int i = static_cast<int>(s) * Lanes; i < last; ++i)
    {
      const int length = rows.Outer[i + 1] - rows.Outer[i] - (hasUnitDiagonal ? 1 : 0);
      if (length > Slices::LongestInSlice)
      {
        longRow.push_back(i);
        longBegin.push_back(longBegin.back() + length);
      }
      else
      {
        longest = std::max(longest, length);
      }
    }
    begin[s + 1] = begin[s] + longest * Lanes;
  }
  const auto size = static_cast<std::size_t>(begin.back());
  const auto longSize = static_cast<std::size_t>(longBegin.back());
  this->NumberOfEntries = static_cast<double>(size + longSize);
  this->Begin = Array<int>(begin.data(), begin.size());
  this->Columns = Array<int>(size);
  this->Singles = Array<float>(size);
  if (!longRow.empty())
  {
    std::vector<char> isLong(n, 0);
    for (const int i : longRow)
    {
      isLong[i] = 1;
    }
    this->IsLong = Array<char>(isLong.data(), isLong.size());
    this->LongRow = Array<int>(longRow.data(), longRow.size());
    this->LongBegin = Array<int>(longBegin.data(), longBegin.size());
    this->LongColumns = Array<int>(longSize);
    this->LongSingles = Array<float>(longSize);
  }
  if (hasDoubles)
  {
    this->Doubles = Array<double>(size);
    this->LongDoubles = Array<double>(longSize);
  }
  this->View = Slices{ n, hasUnitDiagonal, this->Begin.Get(), this->Columns.Get(),
    this->Singles.Get(), this->Doubles.Get(), static_cast<int>(longRow.size()), this->IsLong.Get(),
    this->LongRow.Get(), this->LongBegin.Get(), this->LongColumns.Get(), this->LongSingles.Get(),
    this->LongDoubles.Get() };

  const Array<int> outer(rows.Outer, static_cast<std::size_t>(n) + 1);
  const Array<int> inner(rows.Inner, entries);
  const Array<double> values(rows.Values, entries);
  const FillArguments arguments{ n, outer.Get(), inner.Get(), values.Get(), roots,
    this->Columns.Get(), this->LongColumns.Get(), this->View };
  if (roots)
  {
    Launch(TakeDiagonal, arguments);
  }
  Launch(Fill, arguments);
  Check(cudaDeviceSynchronize(), "matrix");
}

namespace
{

// --- Conjugate gradients ---

struct Outcome
{
  int Iterations;
  int Converged;
  double Residual;
};

/// In the variables of the matrix with unit diagonal: y = D^1/2 x.
struct HeatArguments
{
  Slices A;
  const double* Roots; ///< D^-1/2
  const double* Masses;
  const double* U; ///< u, and the start
  double* X;
  double *B, *Y, *R, *P, *Q; ///< of K columns
  double Tolerance;
  double MostOfOnePass; ///< the least reduction by one pass in single precision
  int MaximumNumberOfIterations;
  float *R1, *P1, *Q1, *Y1; ///< of the iteration in single precision
  double* Work;
  Outcome* Result;
};

/// B and Y of the start; `sums` are the squares of B.
template <int K>
__device__ void TakeStart(const HeatArguments& a, double (&sums)[K])
{
  ForEach(a.A.Rows,
    [&](int i)
    {
      const double root = a.Roots[i];
      const double mass = a.Masses[i];
      Row<double, K> u = Rows<double, K>(a.U)[i];
      Row<double, K> b = u;
      for (int k = 0; k < K; ++k)
      {
        b.At[k] *= root * mass;
        u.At[k] /= root;
        sums[k] += b.At[k] * b.At[k];
      }
      Rows<double, K>(a.B)[i] = b;
      Rows<double, K>(a.Y)[i] = u;
    });
}

/// R = B - A Y, and its squares.
template <int K>
__device__ void TakeResidual(const HeatArguments& a, double (&sums)[K])
{
  ForRows(a.A, Rows<double, K>(a.Y),
    [&](int i, const Row<double, K>& product)
    {
      Row<double, K> r = Rows<double, K>(a.B)[i];
      for (int k = 0; k < K; ++k)
      {
        r.At[k] -= product.At[k];
        sums[k] += r.At[k] * r.At[k];
      }
      Rows<double, K>(a.R)[i] = r;
    });
}

template <int K>
__device__ void GiveSolution(const HeatArguments& a)
{
  ForEach(a.A.Rows,
    [&](int i)
    {
      Row<double, K> x = Rows<double, K>(a.Y)[i];
      for (int k = 0; k < K; ++k)
      {
        x.At[k] *= a.Roots[i];
      }
      Rows<double, K>(a.X)[i] = x;
    });
}

/// Of each column, in shared memory; the first thread of each block computes the same numbers.
template <int K>
struct Columns
{
  double Total[K];
  double Reference[K]; ///< squared length of b
  double Length[K]; ///< of the residual at the start of a pass
  double FirstLength[K]; ///< the unit of single precision
  double Square[K]; ///< of the residual in this unit
  double Goal[K]; ///< of the square
  double Rho[K];
  double Residual; ///< the largest relative one
  double Alpha[K], Beta[K];
  bool IsActive[K];
  bool GoesOn; ///< any of them
};

template <int K>
__device__ void SetReference(const GridSums<K>& sums, Columns<K>& s)
{
  if (threadIdx.x == 0)
  {
    for (int k = 0; k < K; ++k)
    {
      s.Reference[k] = sums[k] > 0.0 ? sums[k] : 1.0;
      s.Length[k] = s.FirstLength[k] = s.Square[k] = 0.0;
    }
  }
  __syncthreads();
}

/// ConjugateGradientSolver::PlanPass(): by how much the next pass reduces each residual.
template <int K>
__device__ void PlanPass(
  const HeatArguments& a, const GridSums<K>& sums, bool isSingle, Columns<K>& s)
{
  if (threadIdx.x == 0)
  {
    s.Residual = 0.0;
    s.GoesOn = false;
    for (int k = 0; k < K; ++k)
    {
      const double before = s.Length[k];
      s.Length[k] = sqrt(sums[k]);
      const double residual = s.Length[k] / sqrt(s.Reference[k]);
      s.Residual = fmax(s.Residual, residual);
      const bool hasStalled = before > 0.0 && !(s.Length[k] <= 0.1 * before);
      s.IsActive[k] = residual > a.Tolerance && !hasStalled;
      s.GoesOn = s.GoesOn || s.IsActive[k];
      if (s.IsActive[k])
      {
        double reduction = 0.7 * a.Tolerance / residual;
        if (isSingle && reduction < 1e-5)
        {
          reduction = pow(reduction, 1.0 / ceil(log(reduction) / log(a.MostOfOnePass)));
        }
        if (s.FirstLength[k] == 0.0)
        {
          s.FirstLength[k] = s.Length[k];
        }
        const double last = s.Square[k];
        const double length = s.Length[k] / s.FirstLength[k];
        s.Square[k] = length * length;
        s.Beta[k] = last > 0.0 ? s.Square[k] / last : 0.0;
        s.Goal[k] = reduction * reduction * s.Square[k];
      }
    }
  }
  __syncthreads();
}

/// Iterations with numbers T on Y, whose residual is R. Returns their number.
template <typename T, int K>
__device__ int Descend(
  const Slices& a, int most, T* r1, T* p1, T* q1, T* y1, GridSums<K>& sums, Columns<K>& s)
{
  Row<T, K>* const r = Rows<T, K>(r1);
  Row<T, K>* const p = Rows<T, K>(p1);
  Row<T, K>* const q = Rows<T, K>(q1);
  Row<T, K>* const y = Rows<T, K>(y1);
  int iterations = 0;
  while (s.GoesOn && iterations < most)
  {
    ++iterations;
    double dots[K] = {};
    ForRows(a, static_cast<const Row<T, K>*>(p),
      [&](int i, const Row<T, K>& product)
      {
        const Row<T, K> pi = p[i];
        for (int k = 0; k < K; ++k)
        {
          dots[k] += static_cast<double>(product.At[k] * pi.At[k]);
        }
        q[i] = product;
      });
    sums.Take(dots);
    if (threadIdx.x == 0)
    {
      for (int k = 0; k < K; ++k)
      {
        s.Alpha[k] = s.IsActive[k] ? s.Square[k] / sums[k] : 0.0;
      }
    }
    __syncthreads();
    double squares[K] = {};
    ForEach(a.Rows,
      [&](int i)
      {
        Row<T, K> ri = r[i];
        const Row<T, K> qi = q[i];
        for (int k = 0; k < K; ++k)
        {
          ri.At[k] -= static_cast<T>(s.Alpha[k]) * qi.At[k];
          squares[k] += static_cast<double>(ri.At[k] * ri.At[k]);
        }
        r[i] = ri;
      });
    sums.Take(squares);
    if (threadIdx.x == 0)
    {
      s.GoesOn = false;
      for (int k = 0; k < K; ++k)
      {
        if (s.IsActive[k])
        {
          s.IsActive[k] = sums[k] > s.Goal[k];
          s.Beta[k] = sums[k] / s.Square[k];
          s.Square[k] = s.IsActive[k] ? sums[k] : s.Square[k];
          s.GoesOn = s.GoesOn || s.IsActive[k];
        }
      }
    }
    __syncthreads();
    ForEach(a.Rows,
      [&](int i)
      {
        Row<T, K> yi = y[i];
        Row<T, K> pi = p[i];
        const Row<T, K> ri = r[i];
        for (int k = 0; k < K; ++k)
        {
          yi.At[k] += static_cast<T>(s.Alpha[k]) * pi.At[k];
          if (s.IsActive[k])
          {
            pi.At[k] = ri.At[k] + static_cast<T>(s.Beta[k]) * pi.At[k];
          }
        }
        y[i] = yi;
        p[i] = pi;
      });
    MeetAll();
  }
  return iterations;
}

template <int K>
__device__ void GiveOutcome(const HeatArguments& a, int iterations, const Columns<K>& s)
{
  if (Thread() == 0)
  {
    *a.Result = Outcome{ iterations, s.Residual <= a.Tolerance ? 1 : 0, s.Residual };
  }
}

template <typename T, int K>
__device__ void SolveByPasses(const HeatArguments& a, T* r1, T* p1, T* q1, T* y1)
{
  __shared__ Columns<K> s;
  GridSums<K> sums(a.Work, s.Total);
  double squares[K] = {};
  TakeStart<K>(a, squares);
  sums.Take(squares);
  SetReference(sums, s);
  int iterations = 0;
  while (true)
  {
    double lengths[K] = {};
    TakeResidual<K>(a, lengths);
    sums.Take(lengths);
    PlanPass(a, sums, sizeof(T) == sizeof(float), s);
    if (!s.GoesOn || iterations >= a.MaximumNumberOfIterations)
    {
      break;
    }
    ForEach(a.A.Rows,
      [&](int i)
      {
        const Row<double, K> r = Rows<double, K>(a.R)[i];
        const Row<T, K> last = Rows<T, K>(p1)[i];
        Row<T, K> scaled = {};
        Row<T, K> p = {};
        for (int k = 0; k < K; ++k)
        {
          if (s.IsActive[k])
          {
            scaled.At[k] = static_cast<T>(r.At[k] / s.FirstLength[k]);
            p.At[k] = scaled.At[k];
            p.At[k] += s.Beta[k] > 0.0 ? static_cast<T>(s.Beta[k]) * last.At[k] : T(0);
          }
        }
        Rows<T, K>(r1)[i] = scaled;
        Rows<T, K>(p1)[i] = p;
        Rows<T, K>(y1)[i] = Row<T, K>{};
      });
    MeetAll();
    iterations +=
      Descend<T, K>(a.A, a.MaximumNumberOfIterations - iterations, r1, p1, q1, y1, sums, s);
    ForEach(a.A.Rows,
      [&](int i)
      {
        Row<double, K> y = Rows<double, K>(a.Y)[i];
        const Row<T, K> step = Rows<T, K>(y1)[i];
        for (int k = 0; k < K; ++k)
        {
          y.At[k] += s.FirstLength[k] * static_cast<double>(step.At[k]);
        }
        Rows<double, K>(a.Y)[i] = y;
      });
    MeetAll();
  }
  GiveSolution<K>(a);
  GiveOutcome(a, iterations, s);
}

template <int K>
__global__ void __launch_bounds__(Threads, K > 4 ? 2 : 4) SolveMixed(HeatArguments a)
{
  SolveByPasses<float, K>(a, a.R1, a.P1, a.Q1, a.Y1);
}

/// X serves as the residual in units of its first length.
template <int K>
__global__ void __launch_bounds__(Threads, K > 4 ? 2 : 4) SolveDouble(HeatArguments a)
{
  SolveByPasses<double, K>(a, a.X, a.P, a.Q, reinterpret_cast<double*>(a.R1));
}

// --- Multigrid ---

struct Level
{
  Slices A, Prolongation, Restriction;
  const float* InverseD;
  float *B, *X, *R, *D, *E;
};

struct Hierarchy
{
  const Level* Levels;
  int Count;
  const float* Inverse; ///< of the coarsest matrix
  int Coarsest; ///< its rows
  float *B, *X; ///< of it
};

struct MultigridArguments
{
  HeatArguments Heat;
  Hierarchy Cycle;
  int Repetitions;
};

/// The second term of the smoother, see Multigrid::Cycle().
template <int K>
__device__ Row<float, K> SecondTerm(const Row<float, K>& d, float inverseD, const Row<float, K>& r)
{
  Row<float, K> term;
  for (int k = 0; k < K; ++k)
  {
    term.At[k] = 0.2F * d.At[k] + 2.4F * inverseD * r.At[k];
  }
  return term;
}

template <int K>
__device__ Row<float, K> FirstTerm(float inverseD, const Row<float, K>& r)
{
  Row<float, K> term;
  for (int k = 0; k < K; ++k)
  {
    term.At[k] = 4.0F / 3.0F * inverseD * r.At[k];
  }
  return term;
}

/// X = inverse B, each row by a warp.
template <int K>
__device__ void SolveCoarsest(const Hierarchy& h)
{
  const Row<float, K>* const b = Rows<float, K>(h.B);
  const int lane = static_cast<int>(threadIdx.x) % WarpWidth;
  const int warps = NumberOfThreads() / WarpWidth;
  for (int i = Thread() / WarpWidth; i < h.Coarsest; i += warps)
  {
    double sums[K] = {};
    for (int j = lane; j < h.Coarsest; j += WarpWidth)
    {
      const float entry = __ldg(h.Inverse + static_cast<std::ptrdiff_t>(i) * h.Coarsest + j);
      for (int k = 0; k < K; ++k)
      {
        sums[k] += static_cast<double>(entry * b[j].At[k]);
      }
    }
    SumOverWarp(sums);
    if (lane == 0)
    {
      for (int k = 0; k < K; ++k)
      {
        Rows<float, K>(h.X)[i].At[k] = static_cast<float>(sums[k]);
      }
    }
  }
}

/// Multigrid::Cycle() on all levels. load(i): row i of the right-hand side; finish(i, x): row i of
/// the result, before the last barrier, which is the caller's.
template <int K, typename Load, typename Finish>
__device__ void RunCycle(const Hierarchy& h, const Load& load, const Finish& finish)
{
  using Numbers = Row<float, K>;
  ForEach(h.Levels[0].A.Rows,
    [&](int i)
    {
      const Numbers b = load(i);
      Rows<float, K>(h.Levels[0].B)[i] = b;
      Rows<float, K>(h.Levels[0].D)[i] = FirstTerm(h.Levels[0].InverseD[i], b);
    });
  MeetAll();
  for (int l = 0; l < h.Count; ++l)
  {
    const Level level = h.Levels[l];
    ForRows(level.A, static_cast<const Numbers*>(Rows<float, K>(level.D)),
      [&](int i, const Numbers& product)
      {
        const Numbers d = Rows<float, K>(level.D)[i];
        Numbers r = Rows<float, K>(level.B)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= product.At[k];
        }
        const Numbers e = SecondTerm(d, level.InverseD[i], r);
        Numbers x;
        for (int k = 0; k < K; ++k)
        {
          x.At[k] = d.At[k] + e.At[k];
        }
        Rows<float, K>(level.R)[i] = r;
        Rows<float, K>(level.E)[i] = e;
        Rows<float, K>(level.X)[i] = x;
      });
    MeetAll();
    ForRows(level.A, static_cast<const Numbers*>(Rows<float, K>(level.E)),
      [&](int i, const Numbers& product)
      {
        Numbers r = Rows<float, K>(level.R)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= product.At[k];
        }
        Rows<float, K>(level.R)[i] = r;
      });
    MeetAll();
    const bool isLast = l + 1 == h.Count;
    ForRows(level.Restriction, static_cast<const Numbers*>(Rows<float, K>(level.R)),
      [&](int i, const Numbers& product)
      {
        Rows<float, K>(isLast ? h.B : h.Levels[l + 1].B)[i] = product;
        if (!isLast)
        {
          Rows<float, K>(h.Levels[l + 1].D)[i] = FirstTerm(h.Levels[l + 1].InverseD[i], product);
        }
      });
    MeetAll();
  }
  SolveCoarsest<K>(h);
  MeetAll();
  for (int l = h.Count - 1; l >= 0; --l)
  {
    const Level level = h.Levels[l];
    const float* const coarse = l + 1 == h.Count ? h.X : h.Levels[l + 1].X;
    ForRows(level.Prolongation, Rows<float, K>(coarse),
      [&](int i, const Numbers& product)
      {
        Numbers x = Rows<float, K>(level.X)[i];
        for (int k = 0; k < K; ++k)
        {
          x.At[k] += product.At[k];
        }
        Rows<float, K>(level.X)[i] = x;
      });
    MeetAll();
    ForRows(level.A, static_cast<const Numbers*>(Rows<float, K>(level.X)),
      [&](int i, const Numbers& product)
      {
        Numbers r = Rows<float, K>(level.B)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= product.At[k];
        }
        Rows<float, K>(level.R)[i] = r;
        Rows<float, K>(level.D)[i] = FirstTerm(level.InverseD[i], r);
      });
    MeetAll();
    ForRows(level.A, static_cast<const Numbers*>(Rows<float, K>(level.D)),
      [&](int i, const Numbers& product)
      {
        const Numbers d = Rows<float, K>(level.D)[i];
        Numbers r = Rows<float, K>(level.R)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= product.At[k];
        }
        const Numbers second = SecondTerm(d, level.InverseD[i], r);
        Numbers x = Rows<float, K>(level.X)[i];
        for (int k = 0; k < K; ++k)
        {
          x.At[k] += d.At[k] + second.At[k];
        }
        Rows<float, K>(level.X)[i] = x;
        if (l == 0)
        {
          finish(i, x);
        }
      });
    if (l > 0)
    {
      MeetAll();
    }
  }
}

template <int K>
__global__ void __launch_bounds__(Threads, K > 4 ? 2 : 4) RepeatCycle(MultigridArguments m)
{
  const HeatArguments& a = m.Heat;
  for (int repetition = 0; repetition < m.Repetitions; ++repetition)
  {
    RunCycle<K>(
      m.Cycle,
      [&](int i)
      {
        Row<float, K> b;
        for (int k = 0; k < K; ++k)
        {
          b.At[k] = static_cast<float>(a.Roots[i] * Rows<double, K>(a.U)[i].At[k]);
        }
        return b;
      },
      [&](int i, const Row<float, K>& x)
      {
        for (int k = 0; k < K; ++k)
        {
          Rows<double, K>(a.X)[i].At[k] = a.Roots[i] * static_cast<double>(x.At[k]);
        }
      });
    MeetAll();
  }
}

/// The residuals of the columns, and whether they go on.
template <int K>
__device__ void TakeSquares(const HeatArguments& a, const GridSums<K>& sums, Columns<K>& s)
{
  if (threadIdx.x == 0)
  {
    s.GoesOn = false;
    s.Residual = 0.0;
    for (int k = 0; k < K; ++k)
    {
      s.Square[k] = sums[k];
      const double residual = sqrt(sums[k] / s.Reference[k]);
      s.Residual = fmax(s.Residual, residual);
      s.IsActive[k] = residual > a.Tolerance;
      s.GoesOn = s.GoesOn || s.IsActive[k];
    }
  }
  __syncthreads();
}

template <int K>
__global__ void __launch_bounds__(Threads, K > 4 ? 2 : 4) SolveByMultigrid(MultigridArguments m)
{
  __shared__ Columns<K> s;
  const HeatArguments& a = m.Heat;
  GridSums<K> sums(a.Work, s.Total);
  double squares[K] = {};
  TakeStart<K>(a, squares);
  sums.Take(squares);
  SetReference(sums, s);
  double lengths[K] = {};
  TakeResidual<K>(a, lengths);
  sums.Take(lengths);
  TakeSquares(a, sums, s);
  int iterations = 0;
  while (s.GoesOn && iterations < a.MaximumNumberOfIterations)
  {
    // z = the cycle on r, and r.z
    double products[K] = {};
    RunCycle<K>(
      m.Cycle,
      [&](int i)
      {
        const Row<double, K> r = Rows<double, K>(a.R)[i];
        Row<float, K> b;
        for (int k = 0; k < K; ++k)
        {
          b.At[k] = s.Square[k] > 0.0 ? static_cast<float>(r.At[k] / sqrt(s.Square[k])) : 0.0F;
        }
        return b;
      },
      [&](int i, const Row<float, K>& z)
      {
        const Row<double, K> r = Rows<double, K>(a.R)[i];
        for (int k = 0; k < K; ++k)
        {
          products[k] += r.At[k] * (static_cast<double>(z.At[k]) * sqrt(s.Square[k]));
        }
      });
    sums.Take(products);
    if (threadIdx.x == 0)
    {
      for (int k = 0; k < K; ++k)
      {
        s.Beta[k] = iterations > 0 && s.Rho[k] > 0.0 ? sums[k] / s.Rho[k] : 0.0;
        s.Rho[k] = sums[k];
      }
    }
    __syncthreads();
    const bool isFirst = iterations == 0;
    ForEach(a.A.Rows,
      [&](int i)
      {
        const Row<float, K> z = Rows<float, K>(m.Cycle.Levels[0].X)[i];
        Row<double, K> p = {};
        if (!isFirst)
        {
          p = Rows<double, K>(a.P)[i];
        }
        for (int k = 0; k < K; ++k)
        {
          p.At[k] = static_cast<double>(z.At[k]) * sqrt(s.Square[k]) + s.Beta[k] * p.At[k];
        }
        Rows<double, K>(a.P)[i] = p;
      });
    MeetAll();
    ++iterations;
    double dots[K] = {};
    ForRows(a.A, static_cast<const Row<double, K>*>(Rows<double, K>(a.P)),
      [&](int i, const Row<double, K>& product)
      {
        const Row<double, K> p = Rows<double, K>(a.P)[i];
        for (int k = 0; k < K; ++k)
        {
          dots[k] += product.At[k] * p.At[k];
        }
        Rows<double, K>(a.Q)[i] = product;
      });
    sums.Take(dots);
    if (threadIdx.x == 0)
    {
      for (int k = 0; k < K; ++k)
      {
        s.Alpha[k] = s.IsActive[k] && sums[k] > 0.0 ? s.Rho[k] / sums[k] : 0.0;
      }
    }
    __syncthreads();
    double left[K] = {};
    ForEach(a.A.Rows,
      [&](int i)
      {
        Row<double, K> r = Rows<double, K>(a.R)[i];
        Row<double, K> y = Rows<double, K>(a.Y)[i];
        const Row<double, K> q = Rows<double, K>(a.Q)[i];
        const Row<double, K> p = Rows<double, K>(a.P)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= s.Alpha[k] * q.At[k];
          y.At[k] += s.Alpha[k] * p.At[k];
          left[k] += r.At[k] * r.At[k];
        }
        Rows<double, K>(a.R)[i] = r;
        Rows<double, K>(a.Y)[i] = y;
      });
    sums.Take(left);
    TakeSquares(a, sums, s);
  }
  double residuals[K] = {};
  TakeResidual<K>(a, residuals);
  sums.Take(residuals);
  TakeSquares(a, sums, s);
  GiveSolution<K>(a);
  if (Thread() == 0)
  {
    *a.Result = Outcome{ iterations, s.Residual <= 2.0 * a.Tolerance ? 1 : 0, s.Residual };
  }
}

} // namespace

// --- The host's side ---

struct HeatSolver::Data
{
  int Vertices;
  Array<double> Roots;
  DeviceRows A;
  Array<double> Masses;
  Array<double> Work;
  Array<Outcome> Result;
  double MostOfOnePass;

  int Columns = 0;
  Array<double> U, X, B, Y, R, P, Q;
  Array<float> Singles; // R1, P1, Q1, Y1; R1 and P1 together also numbers in double precision

  struct DeviceLevel
  {
    DeviceRows A, Prolongation, Restriction;
    Array<float> InverseD, Numbers;
  };
  std::vector<std::unique_ptr<DeviceLevel>> Levels;
  Array<float> Inverse, CoarsestNumbers;
  int Coarsest = 0;
  Array<Level> Views;

  HeatArguments Arguments() const
  {
    const std::size_t size = static_cast<std::size_t>(this->Vertices) * this->Columns;
    float* const singles = this->Singles.Get();
    return { this->A.View, this->Roots.Get(), this->Masses.Get(), this->U.Get(), this->X.Get(),
      this->B.Get(), this->Y.Get(), this->R.Get(), this->P.Get(), this->Q.Get(), 0.0,
      this->MostOfOnePass, 0, singles, singles + size, singles + 2 * size, singles + 3 * size,
      this->Work.Get(), this->Result.Get() };
  }

  /// Vectors for as many columns.
  void Resize(int columns)
  {
    if (this->Columns == columns)
    {
      return;
    }
    const std::size_t size = static_cast<std::size_t>(this->Vertices) * columns;
    for (Array<double>* numbers :
      { &this->U, &this->X, &this->B, &this->Y, &this->R, &this->P, &this->Q })
    {
      *numbers = Array<double>(size);
      Check(cudaMemset(numbers->Get(), 0xff, size * sizeof(double)), "memory");
    }
    this->Singles = Array<float>(4 * size);
    this->Columns = columns;
    this->ResizeLevels();
  }

  void ResizeLevels()
  {
    if (this->Levels.empty() || this->Columns == 0)
    {
      return;
    }
    std::vector<Level> views;
    for (const auto& level : this->Levels)
    {
      const Slices& a = level->A.View.Rows > 0 ? level->A.View : this->A.View;
      const std::size_t size = static_cast<std::size_t>(a.Rows) * this->Columns;
      level->Numbers = Array<float>(5 * size);
      float* const numbers = level->Numbers.Get();
      views.push_back(
        Level{ a, level->Prolongation.View, level->Restriction.View, level->InverseD.Get(), numbers,
          numbers + size, numbers + 2 * size, numbers + 3 * size, numbers + 4 * size });
    }
    this->Views = Array<Level>(views.data(), views.size());
    this->CoarsestNumbers = Array<float>(2 * static_cast<std::size_t>(this->Coarsest) * Columns);
  }

  template <int K>
  void Start(SolveMethod method, const HeatArguments& arguments) const
  {
    switch (method)
    {
      case SolveMethod::Double:
        Launch(SolveDouble<K>, arguments);
        return;
      case SolveMethod::Mixed:
        Launch(SolveMixed<K>, arguments);
        return;
      case SolveMethod::Multigrid:
        Launch(SolveByMultigrid<K>, this->CycleArguments(arguments, 1));
        return;
    }
  }

  MultigridArguments CycleArguments(const HeatArguments& arguments, int repetitions) const
  {
    float* const numbers = this->CoarsestNumbers.Get();
    const Hierarchy hierarchy{ this->Views.Get(), static_cast<int>(this->Levels.size()),
      this->Inverse.Get(), this->Coarsest, numbers,
      numbers + static_cast<std::ptrdiff_t>(this->Coarsest) * this->Columns };
    return { arguments, hierarchy, repetitions };
  }
};

HeatSolver::HeatSolver(const HostRows& matrix, const double* masses, double share)
  : D(std::make_unique<Data>())
{
  const auto n = static_cast<std::size_t>(matrix.Count);
  this->D->Vertices = matrix.Count;
  this->D->Roots = Array<double>(n);
  this->D->A = DeviceRows(matrix, true, this->D->Roots.Get(), true);
  this->D->Masses = Array<double>(masses, n);
  this->D->Work = Array<double>(2 * static_cast<std::size_t>(MostBlocks) * MostColumns);
  this->D->Result = Array<Outcome>(1);
  this->D->MostOfOnePass = share >= 0.05 ? 1e-5 : 1e-4; // as ConjugateGradientSolver
}

HeatSolver::~HeatSolver() = default;

void HeatSolver::SetHierarchy(
  const std::vector<HostLevel>& levels, const std::vector<float>& coarsest)
{
  this->D->Levels.clear();
  for (const HostLevel& level : levels)
  {
    auto device = std::make_unique<Data::DeviceLevel>();
    if (!this->D->Levels.empty()) // the finest matrix is that of the solver
    {
      device->A = DeviceRows(level.A, false, nullptr, false);
    }
    device->Prolongation = DeviceRows(level.Prolongation, false, nullptr, false);
    device->Restriction = DeviceRows(level.Restriction, false, nullptr, false);
    const std::vector<float> inverse(level.InverseD, level.InverseD + level.A.Count);
    device->InverseD = Array<float>(inverse.data(), inverse.size());
    this->D->Levels.push_back(std::move(device));
  }
  this->D->Coarsest =
    static_cast<int>(std::lround(std::sqrt(static_cast<double>(coarsest.size()))));
  this->D->Inverse = Array<float>(coarsest.data(), coarsest.size());
  this->D->ResizeLevels();
}

void HeatSolver::Upload(const double* u, int columns)
{
  this->D->Resize(columns);
  this->D->U.Take(u);
}

void HeatSolver::Download(double* x) const
{
  this->D->X.Give(x, this->D->X.Size());
}

SolveResult HeatSolver::Solve(SolveMethod method, double tolerance, int maximumNumberOfIterations)
{
  HeatArguments arguments = this->D->Arguments();
  arguments.Tolerance = tolerance;
  arguments.MaximumNumberOfIterations = maximumNumberOfIterations;
  Timer timer;
  timer.Start();
  this->D->Columns == 1 ? this->D->Start<1>(method, arguments)
                        : this->D->Start<8>(method, arguments);
  const double milliseconds = timer.Milliseconds();
  Check(cudaGetLastError(), "solve");
  Outcome outcome;
  this->D->Result.Give(&outcome, 1);
  return { outcome.Iterations, outcome.Residual, outcome.Converged != 0, milliseconds };
}

SolveResult HeatSolver::Cycle(int count)
{
  const MultigridArguments arguments = this->D->CycleArguments(this->D->Arguments(), count);
  Timer timer;
  timer.Start();
  if (this->D->Columns == 1)
  {
    Launch(RepeatCycle<1>, arguments);
  }
  else
  {
    Launch(RepeatCycle<8>, arguments);
  }
  const double milliseconds = timer.Milliseconds();
  Check(cudaGetLastError(), "cycle");
  return { count, 0.0, true, milliseconds / count };
}

double HeatSolver::EntriesOfMatrix() const
{
  return this->D->A.NumberOfEntries;
}

double HeatSolver::EntriesOfLevels() const
{
  // Four products with A, one with each of the others.
  double entries = 0.0;
  for (const auto& level : this->D->Levels)
  {
    const DeviceRows& a = level->A.View.Rows > 0 ? level->A : this->D->A;
    entries += 4.0 * a.NumberOfEntries + level->Prolongation.NumberOfEntries +
      level->Restriction.NumberOfEntries;
  }
  return entries;
}

// --- The device ---

namespace
{

struct BarrierArguments
{
  int Count;
};

__global__ void __launch_bounds__(Threads, 4) MeetOften(BarrierArguments a)
{
  for (int i = 0; i < a.Count; ++i)
  {
    MeetAll();
  }
}

double GigabytesPerSecond(
  void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, int times)
{
  std::vector<double> measured;
  for (int i = 0; i < times; ++i)
  {
    Timer timer;
    timer.Start();
    Check(cudaMemcpy(to, from, bytes, kind), "copy");
    measured.push_back(timer.Milliseconds());
  }
  std::sort(measured.begin(), measured.end());
  return static_cast<double>(bytes) * 1e-6 / measured[measured.size() / 2];
}

} // namespace

Bandwidth MeasureBandwidth(std::size_t bytes)
{
  const Array<char> a(bytes);
  const Array<char> b(bytes);
  std::vector<char> pageable(bytes, 1);
  void* pinned = nullptr;
  Check(cudaMallocHost(&pinned, bytes), "pinned memory");
  std::memset(pinned, 1, bytes);
  Bandwidth result;
  result.PageableUp =
    GigabytesPerSecond(a.Get(), pageable.data(), bytes, cudaMemcpyHostToDevice, 5);
  result.PageableDown =
    GigabytesPerSecond(pageable.data(), a.Get(), bytes, cudaMemcpyDeviceToHost, 5);
  result.PinnedUp = GigabytesPerSecond(b.Get(), pinned, bytes, cudaMemcpyHostToDevice, 5);
  result.PinnedDown = GigabytesPerSecond(pinned, b.Get(), bytes, cudaMemcpyDeviceToHost, 5);
  result.OnDevice = 2.0 * GigabytesPerSecond(b.Get(), a.Get(), bytes, cudaMemcpyDeviceToDevice, 21);
  cudaFreeHost(pinned);
  return result;
}

double* AllocatePinned(std::size_t count)
{
  void* numbers = nullptr;
  Check(cudaMallocHost(&numbers, count * sizeof(double)), "pinned memory");
  return static_cast<double*>(numbers);
}

void FreePinned(double* numbers)
{
  cudaFreeHost(numbers);
}

double MeasureBarrier()
{
  constexpr int count = 1000;
  double milliseconds = 0.0;
  for (int i = 0; i < 2; ++i)
  {
    Timer timer;
    timer.Start();
    Launch(MeetOften, BarrierArguments{ count });
    milliseconds = timer.Milliseconds();
  }
  return 1e3 * milliseconds / count;
}

std::string StartDevice(double& seconds)
{
#ifdef __CUDACC__
  const auto begin = std::chrono::steady_clock::now();
  Check(cudaFree(nullptr), "no CUDA device");
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  cudaDeviceProp properties;
  Check(cudaGetDeviceProperties(&properties, 0), "device");
  return std::string(properties.name) + ", " + std::to_string(properties.multiProcessorCount) +
    " multiprocessors, L2 " + std::to_string(properties.l2CacheSize / 1048576) + " MiB";
#else
  seconds = 0.0;
  return "the CPU in place of a device";
#endif
}

} // namespace SurfaceDiffusion::Gpu
