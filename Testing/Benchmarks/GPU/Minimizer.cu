// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Grid.h"

#include <cmath>
#include <limits>

namespace SurfaceDiffusion::Gpu
{

namespace
{

constexpr double OverRelaxation = 1.7; // as TotalVariationMinimizer, and all below
constexpr double PenaltyFactor = 28.0;
constexpr double StartOfGrowth = 6.0;
constexpr double GrowthFactor = 0.35;
constexpr double SquaredEdgeOverHeight = 4.0 / 3.0;
constexpr int MostInnerIterations = 60;
constexpr int IterationsPerCheck = 10;
constexpr int EarlyMeasurement = 15;
constexpr float LargestBalanced = 0.6F;
constexpr float SmallestBalanced = 0.15F;
constexpr float MostScale = 16.0F;

struct Shape
{
  double Length, X, Y, Weight;
  __device__ double Area() const { return 0.5 * Length * Y * Weight; }
};

/// The map from the values at the corners to the gradient: x and y of First and of Second
/// (GradientMap).
struct PlainMap
{
  double At[4];
  __device__ explicit PlainMap(const Shape& s)
    : At{ 1.0 / s.Length, -s.X / (s.Length * s.Y), 0.0, 1.0 / s.Y }
  {
  }
  /// Of grad phi of two corners.
  __device__ double Dot(int a, int b) const
  {
    return this->OfCorner(a, 0) * this->OfCorner(b, 0) +
      this->OfCorner(a, 1) * this->OfCorner(b, 1);
  }
  __device__ double OfCorner(int a, int axis) const
  {
    return a == 1 ? this->At[axis] : a == 2 ? this->At[2 + axis] : -this->At[axis] - At[2 + axis];
  }
};

struct MinimizerArguments
{
  int Vertices, Triangles;
  const int* TriangleVertices;
  const Shape* Shapes;
  const int* CornersBegin;
  const int* Corners;
  const double* QuadraticAreas; ///< mu A
  double TypicalRange; ///< times StartOfGrowth
  double PenaltyPerEdge; ///< PenaltyFactor sqrt(triangles / vertices)

  float4* Map; ///< r First and r Second
  float* AreaOverPenalty;
  float* Scales;
  double* Weights; ///< 3 per triangle
  float* W; ///< 2 K arrays, of one number per triangle
  float* AtCorners; ///< rows of K, per triangle and corner

  Slices A; ///< without its diagonal
  double* Diagonal;
  double* Roots; ///< of the inverse diagonal

  const double* G;
  double *U, *Residual, *Side;
  float *R, *P, *Q, *Y;
  double* Work;
  double* Result; ///< two numbers

  double Growth, LastGrowth;
  bool HasP;
  double Reduction;
  int Sweeps;
};

/// The first penalty and multipliers of zero. Result: the stiffness and the sum of mu A.
template <int K>
__global__ void __launch_bounds__(Threads, 4) StartMinimizer(MinimizerArguments a)
{
  __shared__ double totals[2];
  GridSums<2> sums(a.Work, totals);
  double both[2] = {};
  ForEach(a.Triangles,
    [&](int t)
    {
      const Shape shape = a.Shapes[t];
      const PlainMap map(shape);
      Row<double, K> corners[3];
      for (int corner = 0; corner < 3; ++corner)
      {
        corners[corner] = Rows<double, K>(a.G)[a.TriangleVertices[3 * t + corner]];
      }
      double range = a.TypicalRange;
      for (int k = 0; k < K; ++k)
      {
        const double u0 = corners[0].At[k], u1 = corners[1].At[k], u2 = corners[2].At[k];
        range = fmax(range, fmax(u0, fmax(u1, u2)) - fmin(u0, fmin(u1, u2)));
      }
      const double steepest = fmax(map.Dot(0, 0), fmax(map.Dot(1, 1), map.Dot(2, 2)));
      const double area = shape.Area();
      const double r = a.PenaltyPerEdge / sqrt(range * range * steepest);
      both[0] += r * area * steepest;
      for (int corner = 0; corner < 3; ++corner)
      {
        a.Weights[3 * t + corner] = -r * area * map.Dot((corner + 1) % 3, (corner + 2) % 3);
      }
      a.Map[t] = float4{ static_cast<float>(r * map.At[0]), static_cast<float>(r * map.At[1]),
        static_cast<float>(r * map.At[2]), static_cast<float>(r * map.At[3]) };
      a.AreaOverPenalty[t] = static_cast<float>(area / r);
      a.Scales[t] = 1.0F;
      for (int c = 0; c < 2 * K; ++c)
      {
        a.W[static_cast<std::ptrdiff_t>(c) * a.Triangles + t] = 0.0F;
      }
    });
  ForEach(a.Vertices,
    [&](int i)
    {
      Rows<double, K>(a.U)[i] = Rows<double, K>(a.G)[i];
      Rows<double, K>(a.Side)[i] = Row<double, K>{};
      both[1] += a.QuadraticAreas[i];
    });
  sums.Take(both);
  if (Thread() == 0)
  {
    a.Result[0] = sums[0];
    a.Result[1] = sums[1];
  }
}

/// The share of the multiplier in w.
template <int K>
__device__ float ShareOf(const float (&w)[2 * K])
{
  float square = 0.0F;
  for (int c = 0; c < 2 * K; ++c)
  {
    square += w[c] * w[c];
  }
  return 1.0F / fmaxf(1.0F, sqrtf(square));
}

template <int K>
__device__ void TakeW(const MinimizerArguments& a, int t, float (&w)[2 * K])
{
  for (int c = 0; c < 2 * K; ++c)
  {
    w[c] = a.W[static_cast<std::ptrdiff_t>(c) * a.Triangles + t];
  }
}

template <int K>
__device__ void GiveW(const MinimizerArguments& a, int t, const float (&w)[2 * K])
{
  for (int c = 0; c < 2 * K; ++c)
  {
    a.W[static_cast<std::ptrdiff_t>(c) * a.Triangles + t] = w[c];
  }
}

/// SlicedSplitting::Balance() and SetGrowth().
template <int K>
__global__ void __launch_bounds__(Threads, 4) SetPenalty(MinimizerArguments a)
{
  if (!a.HasP)
  {
    return;
  }
  ForEach(a.Triangles,
    [&](int t)
    {
      float w[2 * K];
      TakeW<K>(a, t, w);
      const float share = ShareOf<K>(w);
      const float product = 1.0F / share - 1.0F;
      const float scale = a.Scales[t];
      float factor = 1.0F;
      if (product > LargestBalanced && scale * MostScale > 1.0F)
      {
        factor = 0.5F;
      }
      else if (product < SmallestBalanced && scale < MostScale)
      {
        factor = 2.0F;
      }
      if (factor != 1.0F)
      {
        float4 map = a.Map[t];
        map.x *= factor;
        map.y *= factor;
        map.z *= factor;
        map.w *= factor;
        a.Map[t] = map;
        a.AreaOverPenalty[t] /= factor;
        a.Scales[t] = scale * factor;
      }
      for (int c = 0; c < 2 * K; ++c)
      {
        w[c] *= factor + (1.0F - factor) * share;
      }
      if (a.Growth != a.LastGrowth)
      {
        const auto growth = static_cast<float>(a.Growth / a.LastGrowth);
        const float shareNow = ShareOf<K>(w);
        for (int c = 0; c < 2 * K; ++c)
        {
          w[c] *= growth + (1.0F - growth) * shareNow;
        }
      }
      GiveW<K>(a, t, w);
    });
}

/// The matrix at the present penalty.
__global__ void __launch_bounds__(Threads, 4) Assemble(MinimizerArguments a)
{
  ForEach(a.Vertices,
    [&](int i)
    {
      const int begin = a.CornersBegin[i];
      const int end = a.CornersBegin[i + 1];
      double diagonal = a.QuadraticAreas[i];
      for (int at = a.A.Begin[i / Lanes] + i % Lanes; at < a.A.Begin[i / Lanes + 1]; at += Lanes)
      {
        const int j = a.A.Columns[at];
        double entry = 0.0;
        for (int c = begin; c < end; ++c) // padding has j = i, which is none of them
        {
          const int t = a.Corners[c] / 3;
          const int corner = a.Corners[c] - 3 * t;
          const int next = corner == 2 ? 0 : corner + 1;
          const int last = corner == 0 ? 2 : corner - 1;
          const double factor = a.Growth * static_cast<double>(a.Scales[t]);
          if (a.TriangleVertices[3 * t + next] == j)
          {
            entry += factor * a.Weights[3 * t + last];
          }
          if (a.TriangleVertices[3 * t + last] == j)
          {
            entry += factor * a.Weights[3 * t + next];
          }
        }
        a.A.Doubles[at] = -entry;
        diagonal += entry;
      }
      a.Diagonal[i] = diagonal;
      a.Roots[i] = 1.0 / sqrt(diagonal);
    });
}

/// Its scaling to unit diagonal, and the residual of U.
template <int K>
__global__ void __launch_bounds__(Threads, 4) SetResidual(MinimizerArguments a)
{
  ForEach(a.Vertices,
    [&](int i)
    {
      const double root = a.Roots[i];
      for (int at = a.A.Begin[i / Lanes] + i % Lanes; at < a.A.Begin[i / Lanes + 1]; at += Lanes)
      {
        a.A.Singles[at] = static_cast<float>(a.A.Doubles[at] * root * a.Roots[a.A.Columns[at]]);
      }
    });
  Slices plain = a.A;
  plain.HasUnitDiagonal = false;
  ForRows(plain, static_cast<const Row<double, K>*>(Rows<double, K>(a.U)),
    [&](int i, const Row<double, K>& product)
    {
      const Row<double, K> u = Rows<double, K>(a.U)[i];
      const Row<double, K> g = Rows<double, K>(a.G)[i];
      Row<double, K> r = Rows<double, K>(a.Side)[i];
      for (int k = 0; k < K; ++k)
      {
        r.At[k] += a.QuadraticAreas[i] * g.At[k] - (product.At[k] + a.Diagonal[i] * u.At[k]);
      }
      Rows<double, K>(a.Residual)[i] = r;
    });
}

/// What w times factor gives to the corners.
template <int K>
__device__ void Spread(const MinimizerArguments& a, int t, float factor, const float (&w)[2 * K])
{
  const float4 map = a.Map[t];
  Row<float, K> first, second, zeroth;
  for (int k = 0; k < K; ++k)
  {
    first.At[k] = factor * (map.x * w[2 * k] + map.y * w[2 * k + 1]);
    second.At[k] = factor * (map.z * w[2 * k] + map.w * w[2 * k + 1]);
    zeroth.At[k] = -first.At[k] - second.At[k];
  }
  Row<float, K>* const corners = Rows<float, K>(a.AtCorners) + 3 * static_cast<std::ptrdiff_t>(t);
  corners[0] = zeroth;
  corners[1] = first;
  corners[2] = second;
}

template <int K>
__device__ Row<double, K> Gather(const MinimizerArguments& a, int i)
{
  Row<double, K> sum = {};
  for (int c = a.CornersBegin[i]; c < a.CornersBegin[i + 1]; ++c)
  {
    const Row<float, K> row = Rows<float, K>(a.AtCorners)[a.Corners[c]];
    for (int k = 0; k < K; ++k)
    {
      sum.At[k] += static_cast<double>(row.At[k]);
    }
  }
  return sum;
}

/// SlicedSplitting::Update() of triangle t.
template <int K>
__device__ void UpdateTriangle(const MinimizerArguments& a, int t, bool hasP)
{
  const int i0 = a.TriangleVertices[3 * t];
  const int i1 = a.TriangleVertices[3 * t + 1];
  const int i2 = a.TriangleVertices[3 * t + 2];
  const Row<double, K> u0 = Rows<double, K>(a.U)[i0];
  const Row<double, K> u1 = Rows<double, K>(a.U)[i1];
  const Row<double, K> u2 = Rows<double, K>(a.U)[i2];
  const float4 map = a.Map[t];
  float w[2 * K];
  TakeW<K>(a, t, w);
  auto gain = static_cast<float>(a.Growth);
  if (hasP)
  {
    constexpr auto relaxation = static_cast<float>(OverRelaxation);
    gain *= relaxation;
    const float share = ShareOf<K>(w);
    for (int c = 0; c < 2 * K; ++c)
    {
      w[c] *= relaxation * share + (1.0F - relaxation);
    }
  }
  for (int k = 0; k < K; ++k)
  {
    const float first = gain * static_cast<float>(u1.At[k] - u0.At[k]);
    const float second = gain * static_cast<float>(u2.At[k] - u0.At[k]);
    w[2 * k] += first * map.x + second * map.z;
    w[2 * k + 1] += first * map.y + second * map.w;
  }
  GiveW<K>(a, t, w);
  Spread<K>(a, t, a.AreaOverPenalty[t] * (1.0F - 2.0F * ShareOf<K>(w)), w);
}

/// Of each column, in shared memory.
template <int K>
struct Descent
{
  double Total[K];
  double Length[K], Square[K], Goal[K], Alpha[K], Beta[K];
  bool IsActive[K];
  bool GoesOn;
};

/// QuadraticDescent::Improve() in single precision. squares: of the residual in the norm of the
/// inverse diagonal, of this thread.
template <int K>
__device__ int Improve(
  const MinimizerArguments& a, GridSums<K>& sums, Descent<K>& s, double (&squares)[K])
{
  sums.Take(squares);
  if (threadIdx.x == 0)
  {
    s.GoesOn = false;
    for (int k = 0; k < K; ++k)
    {
      s.Length[k] = sqrt(sums[k]);
      s.Square[k] = 1.0;
      s.Goal[k] = a.Reduction * a.Reduction;
      s.IsActive[k] = s.Length[k] > 0.0;
      s.GoesOn = s.GoesOn || s.IsActive[k];
    }
  }
  __syncthreads();
  ForEach(a.Vertices,
    [&](int i)
    {
      Row<float, K> r = {};
      for (int k = 0; k < K; ++k)
      {
        if (s.IsActive[k])
        {
          r.At[k] =
            static_cast<float>(a.Roots[i] * Rows<double, K>(a.Residual)[i].At[k] / s.Length[k]);
        }
      }
      Rows<float, K>(a.R)[i] = r;
      Rows<float, K>(a.P)[i] = r;
      Rows<float, K>(a.Y)[i] = Row<float, K>{};
    });
  MeetAll();
  int iterations = 0;
  while (s.GoesOn && iterations < MostInnerIterations)
  {
    ++iterations;
    double dots[K] = {};
    ForRows(a.A, static_cast<const Row<float, K>*>(Rows<float, K>(a.P)),
      [&](int i, const Row<float, K>& product)
      {
        const Row<float, K> p = Rows<float, K>(a.P)[i];
        for (int k = 0; k < K; ++k)
        {
          dots[k] += static_cast<double>(product.At[k] * p.At[k]);
        }
        Rows<float, K>(a.Q)[i] = product;
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
    double left[K] = {};
    ForEach(a.Vertices,
      [&](int i)
      {
        Row<float, K> r = Rows<float, K>(a.R)[i];
        const Row<float, K> q = Rows<float, K>(a.Q)[i];
        for (int k = 0; k < K; ++k)
        {
          r.At[k] -= static_cast<float>(s.Alpha[k]) * q.At[k];
          left[k] += static_cast<double>(r.At[k] * r.At[k]);
        }
        Rows<float, K>(a.R)[i] = r;
      });
    sums.Take(left);
    if (threadIdx.x == 0)
    {
      s.GoesOn = false;
      for (int k = 0; k < K; ++k)
      {
        if (s.IsActive[k])
        {
          s.IsActive[k] = sums[k] > s.Goal[k];
          s.Beta[k] = sums[k] / s.Square[k];
          s.Square[k] = sums[k];
          s.GoesOn = s.GoesOn || s.IsActive[k];
        }
      }
    }
    __syncthreads();
    ForEach(a.Vertices,
      [&](int i)
      {
        Row<float, K> y = Rows<float, K>(a.Y)[i];
        Row<float, K> p = Rows<float, K>(a.P)[i];
        const Row<float, K> r = Rows<float, K>(a.R)[i];
        for (int k = 0; k < K; ++k)
        {
          y.At[k] += static_cast<float>(s.Alpha[k]) * p.At[k];
          if (s.IsActive[k])
          {
            p.At[k] = r.At[k] + static_cast<float>(s.Beta[k]) * p.At[k];
          }
        }
        Rows<float, K>(a.Y)[i] = y;
        Rows<float, K>(a.P)[i] = p;
      });
    MeetAll();
  }
  ForEach(a.Vertices,
    [&](int i)
    {
      const double root = a.Roots[i];
      const Row<float, K> y = Rows<float, K>(a.Y)[i];
      const Row<float, K> r = Rows<float, K>(a.R)[i];
      Row<double, K> u = Rows<double, K>(a.U)[i];
      Row<double, K> residual;
      for (int k = 0; k < K; ++k)
      {
        u.At[k] += s.Length[k] * root * static_cast<double>(y.At[k]);
        residual.At[k] = s.Length[k] / root * static_cast<double>(r.At[k]);
      }
      Rows<double, K>(a.U)[i] = u;
      Rows<double, K>(a.Residual)[i] = residual;
    });
  MeetAll();
  return iterations;
}

template <int K>
__global__ void __launch_bounds__(Threads, 4) Sweep(MinimizerArguments a)
{
  __shared__ Descent<K> s;
  GridSums<K> sums(a.Work, s.Total);
  int inner = 0;
  for (int sweep = 0; sweep < a.Sweeps; ++sweep)
  {
    ForEach(a.Triangles, [&](int t) { UpdateTriangle<K>(a, t, a.HasP || sweep > 0); });
    MeetAll();
    double squares[K] = {};
    ForEach(a.Vertices,
      [&](int i)
      {
        const Row<double, K> sum = Gather<K>(a, i);
        const Row<double, K> side = Rows<double, K>(a.Side)[i];
        Row<double, K> residual = Rows<double, K>(a.Residual)[i];
        for (int k = 0; k < K; ++k)
        {
          residual.At[k] += sum.At[k] - side.At[k];
          const double scaled = a.Roots[i] * residual.At[k];
          squares[k] += scaled * scaled;
        }
        Rows<double, K>(a.Residual)[i] = residual;
        Rows<double, K>(a.Side)[i] = sum;
      });
    inner += Improve<K>(a, sums, s, squares);
  }
  if (Thread() == 0)
  {
    a.Result[0] = inner;
  }
}

/// Result: the energy of U and the dual function at the multipliers.
template <int K>
__global__ void __launch_bounds__(Threads, 4) Measure(MinimizerArguments a)
{
  __shared__ double totals[2];
  GridSums<2> sums(a.Work, totals);
  double both[2] = {};
  ForEach(a.Triangles,
    [&](int t)
    {
      float w[2 * K];
      TakeW<K>(a, t, w);
      Spread<K>(a, t, a.AreaOverPenalty[t] * (a.HasP ? ShareOf<K>(w) : 1.0F), w);
      const Shape shape = a.Shapes[t];
      const PlainMap map(shape);
      const Row<double, K> u0 = Rows<double, K>(a.U)[a.TriangleVertices[3 * t]];
      const Row<double, K> u1 = Rows<double, K>(a.U)[a.TriangleVertices[3 * t + 1]];
      const Row<double, K> u2 = Rows<double, K>(a.U)[a.TriangleVertices[3 * t + 2]];
      double square = 0.0;
      for (int k = 0; k < K; ++k)
      {
        const double first = u1.At[k] - u0.At[k];
        const double second = u2.At[k] - u0.At[k];
        const double x = first * map.At[0] + second * map.At[2];
        const double y = first * map.At[1] + second * map.At[3];
        square += x * x + y * y;
      }
      both[0] += shape.Area() * sqrt(square);
    });
  MeetAll();
  ForEach(a.Vertices,
    [&](int i)
    {
      const Row<double, K> d = Gather<K>(a, i);
      const double mu = a.QuadraticAreas[i];
      for (int k = 0; k < K; ++k)
      {
        const double g = Rows<double, K>(a.G)[i].At[k];
        const double away = Rows<double, K>(a.U)[i].At[k] - g;
        const double u = g - d.At[k] / mu;
        both[0] += 0.5 * mu * away * away;
        both[1] += d.At[k] * u + 0.5 * mu * (u - g) * (u - g);
      }
    });
  sums.Take(both);
  if (Thread() == 0)
  {
    a.Result[0] = sums[0];
    a.Result[1] = sums[1];
  }
}

/// As in TotalVariationMinimizer.cxx.
struct Pace
{
  double Reduction = 0.1;
  double Growth = 1.0;
  double Smallest = std::numeric_limits<double>::infinity();
  int ChecksSinceSmallest = 0;

  void Take(double gap, double rate)
  {
    if (gap < this->Smallest)
    {
      this->Smallest = gap;
      this->ChecksSinceSmallest = 0;
      this->Growth = std::min(this->Growth + rate * IterationsPerCheck, 4.0 * this->Growth);
      return;
    }
    ++this->ChecksSinceSmallest;
    this->Reduction = std::max(0.02, 0.5 * this->Reduction);
    if (this->ChecksSinceSmallest % 3 == 0 && gap > 2.0 * this->Smallest)
    {
      this->Growth = std::max(1.0, 0.5 * this->Growth);
    }
  }
};

} // namespace

struct Minimizer::Data
{
  int Vertices = 0, Triangles = 0, Columns = 0;
  Array<int> TriangleVertices, CornersBegin, Corners;
  Array<double> Shapes, QuadraticAreas;
  DeviceRows A;
  Array<float> Map, AreaOverPenalty, Scales, W, AtCorners;
  Array<double> Weights, Diagonal, Roots;
  Array<double> G, U, Residual, Side;
  Array<float> Singles;
  Array<double> Work, Result;

  MinimizerArguments Arguments() const
  {
    const std::size_t size = static_cast<std::size_t>(this->Vertices) * this->Columns;
    float* const singles = this->Singles.Get();
    MinimizerArguments a = {};
    a.Vertices = this->Vertices;
    a.Triangles = this->Triangles;
    a.TriangleVertices = this->TriangleVertices.Get();
    a.Shapes = reinterpret_cast<const Shape*>(this->Shapes.Get());
    a.CornersBegin = this->CornersBegin.Get();
    a.Corners = this->Corners.Get();
    a.QuadraticAreas = this->QuadraticAreas.Get();
    a.Map = reinterpret_cast<float4*>(this->Map.Get());
    a.AreaOverPenalty = this->AreaOverPenalty.Get();
    a.Scales = this->Scales.Get();
    a.Weights = this->Weights.Get();
    a.W = this->W.Get();
    a.AtCorners = this->AtCorners.Get();
    a.A = this->A.View;
    a.Diagonal = this->Diagonal.Get();
    a.Roots = this->Roots.Get();
    a.G = this->G.Get();
    a.U = this->U.Get();
    a.Residual = this->Residual.Get();
    a.Side = this->Side.Get();
    a.R = singles;
    a.P = singles + size;
    a.Q = singles + 2 * size;
    a.Y = singles + 3 * size;
    a.Work = this->Work.Get();
    a.Result = this->Result.Get();
    a.PenaltyPerEdge = PenaltyFactor *
      std::sqrt(static_cast<double>(this->Triangles) / static_cast<double>(this->Vertices));
    return a;
  }

  template <int K>
  Report Run(double typicalRange, double stopTolerance, int maximumNumberOfIterations) const
  {
    MinimizerArguments a = this->Arguments();
    a.TypicalRange = StartOfGrowth * typicalRange;
    a.Growth = a.LastGrowth = 1.0;
    Report report;
    Timer all;
    all.Start();
    double both[2];
    Launch(StartMinimizer<K>, a);
    this->Result.Give(both, 2);
    const double rate = GrowthFactor * SquaredEdgeOverHeight * both[1] / both[0];
    Pace pace;
    double startEnergy = 0.0;
    while (true)
    {
      const bool isCheck = report.Iterations % IterationsPerCheck == 0;
      const bool isEarly = report.Iterations == EarlyMeasurement;
      Launch(Measure<K>, a);
      this->Result.Give(both, 2);
      startEnergy = report.Iterations == 0 ? both[0] : startEnergy;
      const double gap = std::max(0.0, both[0] - both[1]);
      report.Gap = gap / std::max(both[0], 1e-3 * startEnergy);
      if (!(report.Gap > stopTolerance) || report.Iterations >= maximumNumberOfIterations)
      {
        break;
      }
      if (isCheck)
      {
        if (report.Iterations > 0)
        {
          pace.Take(gap, rate);
        }
        if (pace.ChecksSinceSmallest == 3)
        {
          report.NeedsDouble = true;
          break;
        }
        a.LastGrowth = a.Growth;
        a.Growth = pace.Growth;
        Launch(SetPenalty<K>, a);
        Launch(Assemble, a);
        Launch(SetResidual<K>, a);
      }
      // Up to the next measurement
      const int next =
        report.Iterations + IterationsPerCheck - report.Iterations % IterationsPerCheck;
      const bool measuresEarly = report.Iterations < EarlyMeasurement && next > EarlyMeasurement;
      a.Sweeps =
        std::min(measuresEarly && !isEarly ? EarlyMeasurement : next, maximumNumberOfIterations) -
        report.Iterations;
      a.Reduction = pace.Reduction;
      Timer timer;
      timer.Start();
      Launch(Sweep<K>, a);
      report.SweepMilliseconds += timer.Milliseconds();
      this->Result.Give(both, 1);
      report.InnerIterations += static_cast<int>(both[0]);
      report.Iterations += a.Sweeps;
      a.HasP = true;
    }
    report.Milliseconds = all.Milliseconds();
    Check(cudaGetLastError(), "minimiser");
    return report;
  }
};

Minimizer::Minimizer(const HostMesh& mesh, const double* quadraticAreas)
  : D(std::make_unique<Data>())
{
  Data& d = *this->D;
  const auto n = static_cast<std::size_t>(mesh.Vertices);
  const auto m = static_cast<std::size_t>(mesh.Triangles);
  d.Vertices = mesh.Vertices;
  d.Triangles = mesh.Triangles;
  d.TriangleVertices = Array<int>(mesh.TriangleVertices, 3 * m);
  d.Shapes = Array<double>(mesh.Shapes, 4 * m);
  d.CornersBegin = Array<int>(mesh.CornersBegin, n + 1);
  d.Corners = Array<int>(mesh.Corners, 3 * m);
  d.QuadraticAreas = Array<double>(quadraticAreas, n);
  const std::vector<double> zeros(static_cast<std::size_t>(mesh.Outer[n]), 0.0);
  d.A = DeviceRows({ mesh.Vertices, mesh.Outer, mesh.Inner, zeros.data() }, true, nullptr, true);
  if (d.A.View.LongRows > 0)
  {
    throw std::runtime_error("the minimiser of this prototype has no vertices with many triangles");
  }
  d.Map = Array<float>(4 * m);
  d.AreaOverPenalty = Array<float>(m);
  d.Scales = Array<float>(m);
  d.Weights = Array<double>(3 * m);
  d.Diagonal = Array<double>(n);
  d.Roots = Array<double>(n);
  d.Work = Array<double>(2 * static_cast<std::size_t>(MostBlocks) * MostColumns);
  d.Result = Array<double>(2);
}

Minimizer::~Minimizer() = default;

void Minimizer::Upload(const double* data, int columns)
{
  Data& d = *this->D;
  if (d.Columns != columns)
  {
    const std::size_t size = static_cast<std::size_t>(d.Vertices) * columns;
    const std::size_t triangles = static_cast<std::size_t>(d.Triangles) * columns;
    for (Array<double>* numbers : { &d.G, &d.U, &d.Residual, &d.Side })
    {
      *numbers = Array<double>(size);
    }
    d.Singles = Array<float>(4 * size);
    d.W = Array<float>(2 * triangles);
    d.AtCorners = Array<float>(3 * triangles);
    d.Columns = columns;
  }
  d.G.Take(data);
}

Minimizer::Report Minimizer::Minimize(
  double typicalRange, double stopTolerance, int maximumNumberOfIterations)
{
  return this->D->Columns == 1
    ? this->D->Run<1>(typicalRange, stopTolerance, maximumNumberOfIterations)
    : this->D->Run<3>(typicalRange, stopTolerance, maximumNumberOfIterations);
}

void Minimizer::Download(double* u) const
{
  this->D->U.Give(u, this->D->U.Size());
}

} // namespace SurfaceDiffusion::Gpu
