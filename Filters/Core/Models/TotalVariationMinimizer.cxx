// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariationMinimizer.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double OverRelaxation = 1.7;
constexpr int InnerIterations = 4;
constexpr int IterationsPerCheck = 10;

/// The penalty on S grad u - p, in units of g at the steepest gradient of one Range on the
/// triangle: small triangles and slivers then have no larger share in the equations than others. It
/// moves work between finding edges and settling values and changes no result. Measured with the
/// factor sqrt(triangles per unknown) on meshes and medial meshes: 14 to 28 is best for noise to a
/// gap of 1e-3, 28 to 50 to 1e-5, the more so the more vertices.
constexpr double Penalty = 28.0;

/// The penalty on u - f - q in the same units: 1 to 10 is best. Very large nu need some more.
constexpr double ValuePenaltyOfGradients = 4.0;
constexpr double ValuePenaltyOfFidelity = 0.1;

EdgeFunction WithoutBeta(EdgeFunction function)
{
  function.Beta = 0.0;
  return function;
}

/// The solution p of p + psi'(p)/r = s as a fraction of s >= 0.
inline double Shrinkage(const EdgeFunction& function, double r, double s)
{
  switch (function.Kind)
  {
    case EdgeFunctionKind::TotalVariation:
      return r * s > 1.0 ? 1.0 - 1.0 / (r * s) : 0.0;
    case EdgeFunctionKind::Charbonnier:
    {
      // The left side is concave: Newton's iterates climb to the solution from below.
      const double start = r / (1.0 + r);
      double p = start * s;
      for (int i = 0; i < 30 && s > 0.0; ++i)
      {
        const double ratio = p / function.Threshold;
        const double g = 1.0 / std::sqrt(1.0 + ratio * ratio);
        const double step = (s - p - p * g / r) / (1.0 + g * g * g / r);
        p += step;
        if (!(step > 1e-15 * s))
        {
          break;
        }
      }
      return s > 0.0 ? std::min(1.0, p / s) : start;
    }
    default:
      return r / (1.0 + r);
  }
}

/// The convex conjugate psi*(|y|), from the square of |y| <= sup psi'.
double Conjugate(const EdgeFunction& function, double squared)
{
  switch (function.Kind)
  {
    case EdgeFunctionKind::TotalVariation:
      return 0.0;
    case EdgeFunctionKind::Charbonnier:
    {
      const double k2 = function.Threshold * function.Threshold;
      return k2 * (1.0 - std::sqrt(std::max(0.0, 1.0 - squared / k2)));
    }
    default:
      return 0.5 * squared;
  }
}

} // namespace

std::vector<GradientMap> PlainGradients(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  std::vector<GradientMap> maps(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      maps[t] = { Gradient(s, 0.0, 1.0, 0.0), Gradient(s, 0.0, 0.0, 1.0) };
    });
  return maps;
}

std::vector<GradientMap> StretchedGradients(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, double along, double across,
  const ParallelFor& parallel)
{
  std::vector<GradientMap> maps = PlainGradients(mesh, parallel);
  const double undirected = std::sqrt(along) * std::sqrt(across);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Eigen::Vector2d e1 = frames.row(t);
      const bool directed = !e1.isZero(0.0);
      const auto stretch = [&](const Eigen::Vector2d& v) -> Eigen::Vector2d
      {
        if (!directed)
        {
          return undirected * v;
        }
        return across * v + ((along - across) * e1.dot(v)) * e1;
      };
      maps[t] = { stretch(maps[t].First), stretch(maps[t].Second) };
    });
  return maps;
}

TotalVariationMinimizer::TotalVariationMinimizer(std::shared_ptr<const Assembler> assembler,
  std::vector<GradientMap> gradients, Vector quadratic, Vector absolute, Flags fixed,
  const Settings& settings, const ParallelFor& parallel)
  : Operators(std::move(assembler))
  , Gradients(std::move(gradients))
  , Quadratic(std::move(quadratic))
  , Absolute(std::move(absolute))
  , Fixed(std::move(fixed))
  , Options(settings)
  , Parallel(parallel)
  , Areas(this->Operators->Mesh().GetReduction().Accumulated(
      this->Operators->Mesh().ControlAreas(), this->AccumulatedAreas))
  , Descent(parallel)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Reduction& reduction = mesh.GetReduction();
  this->NumberOfVertices =
    reduction.SumOverVertices(parallel, mesh.NumberOfVertices(), [](Index) { return 1.0; });
  this->GradientPenalty.resize(mesh.NumberOfTriangles());
  this->ValuePenalty.resize(mesh.NumberOfVertices());
  const EdgeFunction function = WithoutBeta(settings.Function);
  const double perUnknown =
    std::sqrt(reduction.Sum(mesh.NumberOfTriangles()) / this->NumberOfVertices);
  CornerWeights coefficients(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Eigen::Vector2d& first = this->Gradients[t].First;
      const Eigen::Vector2d& second = this->Gradients[t].Second;
      const Eigen::Vector2d zeroth = -first - second;
      const double steepest =
        std::max({ zeroth.squaredNorm(), first.squaredNorm(), second.squaredNorm() });
      const double g = function(settings.Range * settings.Range * steepest);
      const double penalty = Penalty * perUnknown * g * mesh.Shapes()[t].Area();
      this->GradientPenalty[t] = penalty;
      coefficients(t, 0) = -penalty * first.dot(second);
      coefficients(t, 1) = -penalty * second.dot(zeroth);
      coefficients(t, 2) = -penalty * zeroth.dot(first);
    });
  Vector diagonal(mesh.NumberOfVertices());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double area = this->Areas[i];
      const double nu = this->Absolute[i] * area;
      this->ValuePenalty[i] = nu > 0.0
        ? ValuePenaltyOfGradients * function(settings.Range * settings.Range / area) +
          ValuePenaltyOfFidelity * nu / settings.Range
        : 0.0;
      diagonal[i] = reduction.Owns(i) ? area * this->Quadratic[i] + this->ValuePenalty[i] : 0.0;
    });
  TakePattern(this->Operators->Pattern(), this->Matrix, parallel);
  this->Operators->Fill(this->Matrix, diagonal, 1.0, coefficients, nullptr, parallel);
}

TotalVariationMinimizer::Report TotalVariationMinimizer::Minimize(
  const Values& g, const Values& f, Values& u, const ProgressMonitor& progress)
{
  return ForColumns(u.cols(),
    [&](auto k) { return this->MinimizeColumns<decltype(k)::value>(g, f, u, progress); });
}

/// The loops of one iteration for K columns, or for any number of them if K is 0.
template <int K>
struct TotalVariationMinimizer::Pass
{
  TotalVariationMinimizer& Self;
  const Values& G;
  const Values& F;
  const Values& U;
  const int Columns = ColumnCount<K>(U.cols());
  const TriangleMesh& Mesh = Self.Operators->Mesh();
  const Reduction& OverProcesses = Mesh.GetReduction();
  const bool Joint = Self.Options.Coupling == ChannelCoupling::Joint;
  const bool HasAbsolute = (Self.Absolute.array() > 0.0).any();

  int Count() const { return ColumnCount<K>(this->Columns); }

  /// S grad u of channel k on triangle t.
  Eigen::Vector2d GradientOf(Index t, int k) const
  {
    const Triangles& corners = this->Mesh.TriangleVertices();
    const GradientMap& map = this->Self.Gradients[t];
    const double u0 = this->U(corners(t, 0), k);
    return (this->U(corners(t, 1), k) - u0) * map.First +
      (this->U(corners(t, 2), k) - u0) * map.Second;
  }

  /// Calls act(first, last) for the channels that share a norm.
  template <typename Act>
  void ForEachNorm(const Act& act) const
  {
    if (this->Joint)
    {
      act(0, this->Count());
      return;
    }
    for (int k = 0; k < this->Count(); ++k)
    {
      act(k, k + 1);
    }
  }

  void Start()
  {
    ForEach(this->Self.Parallel, this->Mesh.NumberOfTriangles(),
      [&](Index t)
      {
        for (int k = 0; k < this->Count(); ++k)
        {
          const Eigen::Vector2d gradient = this->GradientOf(t, k);
          this->Self.P(t, 2 * k) = gradient[0];
          this->Self.P(t, 2 * k + 1) = gradient[1];
        }
      });
    this->Self.B.setZero();
    if (this->HasAbsolute)
    {
      this->Self.Q = this->U - this->F;
      this->Self.C.setZero();
    }
  }

  /// p and its multiplier from the present u; what they give to the right-hand side.
  void UpdateGradients()
  {
    const EdgeFunction& function = this->Self.Options.Function;
    const Index* vertices = this->Mesh.TriangleVertices().data();
    const double* u = this->U.data();
    ForEach(this->Self.Parallel, this->Mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const int count = this->Count();
        const GradientMap map = this->Self.Gradients[t];
        const double* u0 = u + static_cast<std::ptrdiff_t>(vertices[3 * t]) * count;
        const double* u1 = u + static_cast<std::ptrdiff_t>(vertices[3 * t + 1]) * count;
        const double* u2 = u + static_cast<std::ptrdiff_t>(vertices[3 * t + 2]) * count;
        double* p = &this->Self.P(t, 0);
        double* b = &this->Self.B(t, 0);
        for (int k = 0; k < count; ++k)
        {
          const Eigen::Vector2d gradient = (OverRelaxation * (u1[k] - u0[k])) * map.First +
            (OverRelaxation * (u2[k] - u0[k])) * map.Second;
          b[2 * k] += gradient[0] + (1.0 - OverRelaxation) * p[2 * k];
          b[2 * k + 1] += gradient[1] + (1.0 - OverRelaxation) * p[2 * k + 1];
        }
        const double scale = this->Self.GradientPenalty[t];
        const double r = scale / this->Mesh.Shapes()[t].Area();
        this->ForEachNorm(
          [&](int first, int last)
          {
            double squared = 0.0;
            for (int c = 2 * first; c < 2 * last; ++c)
            {
              squared += b[c] * b[c];
            }
            const double factor = Shrinkage(function, r, std::sqrt(squared));
            for (int c = 2 * first; c < 2 * last; ++c)
            {
              p[c] = factor * b[c];
              b[c] -= p[c];
            }
          });
        double* corner = &this->Self.Corners(3 * t, 0);
        for (int k = 0; k < count; ++k)
        {
          const double x = scale * (p[2 * k] - b[2 * k]);
          const double y = scale * (p[2 * k + 1] - b[2 * k + 1]);
          const double first = map.First[0] * x + map.First[1] * y;
          const double second = map.Second[0] * x + map.Second[1] * y;
          corner[k] = -first - second;
          corner[count + k] = first;
          corner[2 * count + k] = second;
        }
      });
  }

  /// q and its multiplier from the present u, where there is L1 fidelity.
  void UpdateValues()
  {
    ForEach(this->Self.Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double nu = this->Self.Absolute[i] * this->Self.Areas[i];
        if (nu == 0.0)
        {
          return;
        }
        const double threshold = nu / this->Self.ValuePenalty[i];
        auto q = this->Self.Q.row(i);
        auto c = this->Self.C.row(i);
        c += OverRelaxation * (this->U.row(i) - this->F.row(i)) + (1.0 - OverRelaxation) * q;
        this->ForEachNorm(
          [&](int first, int last)
          {
            const double norm = c.segment(first, last - first).norm();
            const double factor = norm > threshold ? 1.0 - threshold / norm : 0.0;
            q.segment(first, last - first) = factor * c.segment(first, last - first);
            c.segment(first, last - first) -= q.segment(first, last - first);
          });
      });
  }

  /// The change of the right-hand side goes into the residual.
  void UpdateResidual()
  {
    this->OverProcesses.AccumulateEach(
      this->Self.Parallel, this->Self.Dual, [&](Index i) { this->AddCorners(i); },
      [&](Index i)
      {
        if (this->Self.Fixed[i])
        {
          return;
        }
        const double mu = this->Self.Areas[i] * this->Self.Quadratic[i];
        const double rho = this->Self.ValuePenalty[i];
        double* side = &this->Self.RightHandSide(i, 0);
        double* residual = &this->Self.Descent.Residual(i, 0);
        for (int k = 0; k < this->Count(); ++k)
        {
          double sum = mu * this->G(i, k);
          if (rho > 0.0)
          {
            sum += rho * (this->F(i, k) + this->Self.Q(i, k) - this->Self.C(i, k));
          }
          sum += this->Self.Dual(i, k);
          residual[k] += sum - side[k];
          side[k] = sum;
        }
      });
  }

  /// Dual = the sum of what the triangles give to vertex i.
  void AddCorners(Index i) const
  {
    const auto& begin = this->Mesh.VertexCornersBegin();
    for (int k = 0; k < this->Count(); ++k)
    {
      double sum = 0.0;
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        sum += this->Self.Corners(this->Mesh.VertexCorners()[c], k);
      }
      this->Self.Dual(i, k) = sum;
    }
  }

  double Energy() const
  {
    const double atVertices = Sum(this->Self.Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        double density =
          0.5 * this->Self.Quadratic[i] * (this->U.row(i) - this->G.row(i)).squaredNorm();
        if (this->Self.Absolute[i] > 0.0)
        {
          this->ForEachNorm(
            [&](int first, int last)
            {
              density += this->Self.Absolute[i] *
                (this->U.row(i) - this->F.row(i)).segment(first, last - first).norm();
            });
        }
        return this->Mesh.ControlAreas()[i] * density;
      });
    return this->Self.GradientEnergy(this->U) + this->OverProcesses.Sum(atVertices);
  }

  /// The dual function at y = r b: the minimum over u of int (y . S grad u - psi*(y)) and the
  /// terms at the vertices.
  double DualEnergy() const
  {
    const EdgeFunction& function = this->Self.Options.Function;
    const double conjugate = Sum(this->Self.Parallel, this->Mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const double area = this->Mesh.Shapes()[t].Area();
        const double r = this->Self.GradientPenalty[t] / area;
        double density = 0.0;
        this->ForEachNorm(
          [&](int first, int last)
          {
            const double squared =
              this->Self.B.row(t).segment(2 * first, 2 * (last - first)).squaredNorm();
            density += Conjugate(function, r * r * squared);
          });
        return area * density;
      });
    ForEach(
      this->Self.Parallel, this->Mesh.NumberOfVertices(), [&](Index i) { this->GatherDual(i); });
    this->OverProcesses.Accumulate(this->Self.Dual);
    const double atVertices =
      this->OverProcesses.SumOverVertices(this->Self.Parallel, this->Mesh.NumberOfVertices(),
        [&](Index i)
        {
          double value = 0.0;
          this->ForEachNorm([&](int first, int last) { value += this->DualAt(i, first, last); });
          return value;
        });
    return atVertices - this->OverProcesses.Sum(conjugate);
  }

  /// d = sum over the corners at i of area (S grad phi_i) . y.
  void GatherDual(Index i) const
  {
    const auto& begin = this->Mesh.VertexCornersBegin();
    const auto& corners = this->Mesh.VertexCorners();
    double* d = &this->Self.Dual(i, 0);
    std::fill(d, d + this->Count(), 0.0);
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      const Index t = corners[c] / 3;
      const int a = corners[c] % 3;
      const GradientMap& map = this->Self.Gradients[t];
      const Eigen::Vector2d v = this->Self.GradientPenalty[t] *
        (a == 1      ? map.First
            : a == 2 ? map.Second
                     : Eigen::Vector2d(-map.First - map.Second));
      const double* b = &this->Self.B(t, 0);
      for (int k = 0; k < this->Count(); ++k)
      {
        d[k] += v[0] * b[2 * k] + v[1] * b[2 * k + 1];
      }
    }
  }

  /// What vertex i adds to the dual function: the minimum over u_i of d . u_i + mu A/2 |u_i - g|^2
  /// + nu A |u_i - f|.
  double DualAt(Index i, int first, int last) const
  {
    const double* d = &this->Self.Dual(i, 0);
    const double mu = this->Self.Areas[i] * this->Self.Quadratic[i];
    const double nu = this->Self.Areas[i] * this->Self.Absolute[i];
    const bool fixed = this->Self.Fixed[i];
    const double range = this->Self.Options.Range * std::sqrt(static_cast<double>(last - first));
    double squared = 0.0; // of d, or of u_i - f without the pull of nu
    double value = 0.0;
    if (fixed || mu == 0.0)
    {
      // Unless fixed, u_i stays at f while |d| < nu, and else goes as far as Range allows.
      double pull = 0.0;
      for (int k = first; k < last; ++k)
      {
        const double u = nu > 0.0 && !fixed ? this->F(i, k) : this->U(i, k);
        value += d[k] * u + 0.5 * mu * std::pow(u - this->G(i, k), 2);
        squared += d[k] * d[k];
        pull += std::pow(u - this->F(i, k), 2);
      }
      const double beyond = fixed ? 0.0 : std::max(0.0, std::sqrt(squared) - nu);
      return value - beyond * range + (nu > 0.0 ? nu * std::sqrt(pull) : 0.0);
    }
    // Without nu, u_i = g - d/mu; it is drawn to f by up to nu/mu.
    double drawn = 0.0;
    if (nu > 0.0)
    {
      for (int k = first; k < last; ++k)
      {
        squared += std::pow(this->G(i, k) - d[k] / mu - this->F(i, k), 2);
      }
      drawn = mu * std::sqrt(squared) > nu ? nu / (mu * std::sqrt(squared)) : 1.0;
    }
    for (int k = first; k < last; ++k)
    {
      const double free = this->G(i, k) - d[k] / mu;
      const double u = drawn > 0.0 ? free + drawn * (this->F(i, k) - free) : free;
      value += d[k] * u + 0.5 * mu * std::pow(u - this->G(i, k), 2);
    }
    return value + nu * (1.0 - drawn) * std::sqrt(squared);
  }
};

template <int K>
TotalVariationMinimizer::Report TotalVariationMinimizer::MinimizeColumns(
  const Values& g, const Values& f, Values& u, const ProgressMonitor& progress)
{
  this->Prepare(u);
  this->Initial = u;
  Pass<K> pass{ *this, g, f, u };
  pass.Start();
  const double startEnergy = pass.Energy();
  const double negligible = std::max(1e-3 * startEnergy, 1e-6 * this->NoiseEnergy());
  Report report;
  double energy = startEnergy;
  double fraction = 0.0;
  while (true)
  {
    if (report.Iterations % IterationsPerCheck == 0)
    {
      energy = pass.Energy();
      const double scale = std::max(energy, negligible);
      report.Gap = scale > 0.0 ? std::max(0.0, energy - pass.DualEnergy()) / scale : 0.0;
      if (!std::isfinite(report.Gap))
      {
        throw std::runtime_error("the minimisation has no finite solution");
      }
      const double left = std::log(std::max(1.0, report.Gap / this->Options.StopTolerance));
      fraction = std::max(fraction, 1.0 - left / std::log(1.0 / this->Options.StopTolerance));
    }
    if (report.Gap <= this->Options.StopTolerance ||
      report.Iterations == this->Options.MaximumNumberOfIterations)
    {
      break;
    }
    progress.Report(fraction);
    ++report.Iterations;
    pass.UpdateGradients();
    if (pass.HasAbsolute)
    {
      pass.UpdateValues();
    }
    pass.UpdateResidual();
    this->Descent.Improve(u, InnerIterations);
  }
  // On triangles flat beyond what the inner iterations can take it may end far off.
  if (report.Gap > this->Options.StopTolerance && pass.Energy() > startEnergy)
  {
    u = this->Initial;
  }
  progress.Report(1.0);
  return report;
}

/// Sizes for as many columns as u has, and the residual of a right-hand side of zero.
void TotalVariationMinimizer::Prepare(const Values& u)
{
  if (this->RightHandSide.cols() != u.cols())
  {
    const Index triangles = this->Operators->Mesh().NumberOfTriangles();
    this->P.resize(triangles, 2 * u.cols());
    this->B.resize(triangles, 2 * u.cols());
    this->Corners.resize(3 * static_cast<Eigen::Index>(triangles), u.cols());
    this->RightHandSide.resize(u.rows(), u.cols());
    this->Dual.resize(u.rows(), u.cols());
    this->Descent.Residual.resize(u.rows(), u.cols());
    if ((this->Absolute.array() > 0.0).any())
    {
      this->Q.resize(u.rows(), u.cols());
      this->C.resize(u.rows(), u.cols());
    }
    this->Load = Values::Zero(u.rows(), u.cols());
    if (this->Fixed.any())
    {
      this->Operators->Constrain(this->Matrix, this->Fixed, u, this->Load, this->Parallel);
    }
    this->Descent.SetMatrix(this->Matrix, this->Operators->Mesh().GetReduction());
  }
  this->RightHandSide.setZero();
  Multiply(this->Matrix, u, this->Descent.Residual, this->Parallel);
  this->Descent.Residual = this->Load - this->Descent.Residual;
  this->Operators->Mesh().GetReduction().Accumulate(this->Descent.Residual);
}

double TotalVariationMinimizer::NoiseEnergy() const
{
  if (this->NumberOfVertices == 0.0)
  {
    return 0.0;
  }
  const TriangleMesh& mesh = this->Operators->Mesh();
  const EdgeFunction exact = WithoutBeta(this->Options.Function);
  const double area = mesh.GetReduction().Sum(mesh.ControlAreas().sum());
  const double ofOne = area / this->NumberOfVertices;
  return area * exact.Potential(this->Options.Range * this->Options.Range / ofOne);
}

double TotalVariationMinimizer::GradientEnergy(const Values& u) const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Triangles& vertices = mesh.TriangleVertices();
  const bool joint = this->Options.Coupling == ChannelCoupling::Joint;
  const EdgeFunction exact = WithoutBeta(this->Options.Function);
  const double here = Sum(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const GradientMap& map = this->Gradients[t];
      const auto u0 = u.row(vertices(t, 0));
      const auto u1 = u.row(vertices(t, 1));
      const auto u2 = u.row(vertices(t, 2));
      double density = 0.0;
      double squared = 0.0;
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
        squared += ((u1[k] - u0[k]) * map.First + (u2[k] - u0[k]) * map.Second).squaredNorm();
        if (!joint || k + 1 == u.cols())
        {
          density += exact.Potential(squared);
          squared = 0.0;
        }
      }
      return mesh.Shapes()[t].Area() * density;
    });
  return mesh.GetReduction().Sum(here);
}

} // namespace SurfaceDiffusion
