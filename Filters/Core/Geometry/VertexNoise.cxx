// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexNoise.h"

#include "Core/Geometry/VertexFans.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr std::size_t SmallestNeighbourhood = 9;
constexpr double LargestLeverage = 2.0;
/// The fraction of vertices that must be away from edges and without outliers, and the quantile of
/// |x| for the standard deviation 1.
constexpr double NoiseFraction = 0.3;
constexpr double NoiseQuantile = 0.3853;
/// The same for its largest values.
constexpr double TailFraction = 0.95;
constexpr double TailQuantile = 1.96;
/// Of larger surfaces, every second, third, ... vertex is used: that many have a quantile within
/// about 1 %.
constexpr Index EnoughVertices = 20000;
/// The least radius of a neighbourhood, in deviations of the noise, and the fraction of vertices whose
/// neighbourhoods may be smaller.
constexpr double LeastRadius = 2.2;
constexpr double NarrowFraction = 0.3;
/// Of sigma in wide neighbourhoods; details have less.
constexpr double LeastShareOfNoise = 0.85;
/// (3/2)^3: the variance of details from three rings of neighbours over that from two.
constexpr double GrowthOfDetails = 3.375;
/// R0 of EstimateVertexNoise().
constexpr double GrowthOfRoughDetails = 1.6;
/// Of EstimateCorrelatedNoise().
constexpr Index EnoughWideNeighbourhoods = 1000;
constexpr Index FewestVertices = 3200; ///< four times those within sixteen rings
constexpr double LeastGrowth = 1.3; ///< from two to four rings
constexpr double LeastGrowthToLevel = 1.8; ///< the same, to a level that is given
constexpr double LargestLateGrowth = 1.6; ///< from eight to sixteen rings
constexpr double SmallestTail = 0.8; ///< of Gaussian noise, over sigma_r
constexpr double SmallestCorrelated = 0.1; ///< in h
constexpr double LargestCorrelated = 1.0; ///< in h
constexpr double RadiusOfLength =
  3.0; ///< at which half of the variance is reached, over the length
/// Of FitCorrelation(): how far sigma_r^2 is explained by the noise, and by all terms.
constexpr double SmallestShare = 0.7;
constexpr double LargestMisfit = 0.6;
constexpr double LargestUncertain = 0.5; ///< level that may be relief, in h

using Quadric = Eigen::Matrix<double, 6, 1>;

struct VertexRange
{
  const Index* First;
  const Index* Last;

  const Index* begin() const { return this->First; }
  const Index* end() const { return this->Last; }
  std::size_t size() const { return static_cast<std::size_t>(this->Last - this->First); }
};

/// A vertex and the vertices up to a number of edges away from it. A vertex with more than
/// LargestFan triangles has neighbours of its own, but does not make them neighbours of each other.
class Neighbourhood
{
public:
  Neighbourhood(const TriangleMesh& mesh, int rings)
    : Mesh(mesh)
    , FoundFrom(static_cast<std::size_t>(mesh.NumberOfVertices()), -1)
    , RingEnds(static_cast<std::size_t>(rings))
  {
  }

  void Find(Index vertex)
  {
    this->Vertices.assign(1, vertex);
    this->FoundFrom[vertex] = vertex;
    std::size_t first = 0;
    for (std::size_t& end : this->RingEnds)
    {
      for (const std::size_t last = this->Vertices.size(); first < last; ++first)
      {
        if (this->Vertices[first] == vertex ||
          NumberOfTrianglesAt(this->Mesh, this->Vertices[first]) <= LargestFan)
        {
          this->AppendNeighbours(this->Vertices[first], vertex);
        }
      }
      end = this->Vertices.size();
    }
  }

  /// The vertices up to this number of edges away, without the vertex itself.
  VertexRange WithinRings(int rings) const
  {
    return { this->Vertices.data() + 1, this->Vertices.data() + this->RingEnds[rings - 1] };
  }

private:
  void AppendNeighbours(Index of, Index vertex)
  {
    const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
    for (Index k = begin[of]; k < begin[of + 1]; ++k)
    {
      for (const int other : { 1, 2 })
      {
        const Index neighbour = this->Mesh.OtherCorner(this->Mesh.VertexCorners()[k], other);
        if (this->FoundFrom[neighbour] != vertex)
        {
          this->FoundFrom[neighbour] = vertex;
          this->Vertices.push_back(neighbour);
        }
      }
    }
  }

  const TriangleMesh& Mesh;
  std::vector<Index> FoundFrom; ///< per vertex: the last vertex near to which it was found
  std::vector<Index> Vertices; ///< ring after ring
  std::vector<std::size_t> RingEnds;
};

/// The rows: two main axes of the points, and the normal. radius: the deviation along the second one.
Eigen::Matrix3d MainAxes(const Points& points, const VertexRange& list, double& radius)
{
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  for (const Index i : list)
  {
    centre += points.row(i);
  }
  centre /= static_cast<double>(list.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Index i : list)
  {
    const Eigen::RowVector3d d = points.row(i) - centre;
    covariance += d.transpose() * d;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  radius = std::sqrt(std::max(0.0, solver.eigenvalues()[1]) / static_cast<double>(list.size()));
  Eigen::Matrix3d axes;
  axes.row(0) = solver.eigenvectors().col(2).transpose();
  axes.row(1) = solver.eigenvectors().col(1).transpose();
  axes.row(2) = axes.row(0).cross(axes.row(1));
  return axes;
}

/// How far a vertex is from the quadric through its neighbours.
struct QuadricDistance
{
  double Standardized = -1.0; ///< negative if the fit is not well determined
  double Radius = 0.0; ///< the deviation of the neighbours along their second axis
};

/// Of the quadric through `list`. h: a length of the size of the neighbourhood.
QuadricDistance DistanceFromQuadric(
  const Points& points, Index vertex, const VertexRange& list, double h)
{
  QuadricDistance result;
  const Eigen::Matrix3d axes = MainAxes(points, list, result.Radius);
  Eigen::Matrix<double, 6, 6> normalMatrix = Eigen::Matrix<double, 6, 6>::Zero();
  Quadric right = Quadric::Zero();
  for (const Index i : list)
  {
    const Eigen::Vector3d d = axes * (points.row(i) - points.row(vertex)).transpose() / h;
    Quadric terms;
    terms << 1.0, d[0], d[1], d[0] * d[0], d[0] * d[1], d[1] * d[1];
    normalMatrix += terms * terms.transpose();
    right += terms * d[2];
  }
  const auto factor = normalMatrix.ldlt();
  const double leverage = factor.solve(Quadric::Unit(0))[0];
  const double distance = std::abs(factor.solve(right)[0]) * h;
  const bool determined = leverage >= 0.0 && leverage < LargestLeverage && std::isfinite(distance);
  result.Standardized = determined ? distance / std::sqrt(1.0 + leverage) : -1.0;
  return result;
}

/// The standard deviation of normally distributed numbers whose absolute values these are, by their
/// small and by their large ones.
struct Deviation
{
  double Sigma;
  double Tail;
  bool IsOfEnough; ///< of the fraction of the vertices that must have one
};

/// Negative distances are left out.
Deviation DeviationOf(std::vector<double>& distances)
{
  const double vertices = static_cast<double>(distances.size());
  distances.erase(std::remove_if(distances.begin(), distances.end(),
                    [](double distance) { return distance < 0.0; }),
    distances.end());
  return { QuantileOf(distances, NoiseFraction) / NoiseQuantile,
    QuantileOf(distances, TailFraction) / TailQuantile,
    static_cast<double>(distances.size()) >= NoiseFraction * vertices };
}

/// Every so many vertices are used to have about `enough` of them.
Index StrideFor(const TriangleMesh& mesh, Index enough)
{
  return std::max<Index>(1, mesh.NumberOfVertices() / enough);
}

/// Per number of rings in ascending `rings`, of every vertex with the stride.
std::vector<std::vector<QuadricDistance>> MeasureDistances(const TriangleMesh& mesh,
  const Points& points, const std::vector<int>& rings, Index stride, const ParallelFor& parallel)
{
  const Index count = mesh.NumberOfVertices() / stride;
  const double h = mesh.MeanEdgeLength();
  std::vector<std::vector<QuadricDistance>> distances(
    rings.size(), std::vector<QuadricDistance>(static_cast<std::size_t>(count)));
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      Neighbourhood neighbourhood(mesh, rings.back());
      for (Index i = begin; i < end; ++i)
      {
        neighbourhood.Find(i * stride);
        for (std::size_t k = 0; k < rings.size(); ++k)
        {
          const VertexRange list = neighbourhood.WithinRings(rings[k]);
          if (list.size() >= SmallestNeighbourhood)
          {
            distances[k][i] = DistanceFromQuadric(points, i * stride, list, h);
          }
        }
      }
    });
  return distances;
}

std::vector<double> Standardized(const std::vector<QuadricDistance>& distances)
{
  std::vector<double> values;
  for (const QuadricDistance& distance : distances)
  {
    values.push_back(distance.Standardized);
  }
  return values;
}

/// sigma_r per number of rings.
std::vector<Deviation> MeasureDeviations(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& rings, Index stride, const ParallelFor& parallel)
{
  std::vector<Deviation> deviations;
  for (const auto& distances : MeasureDistances(mesh, points, rings, stride, parallel))
  {
    std::vector<double> values = Standardized(distances);
    deviations.push_back(DeviationOf(values));
  }
  return deviations;
}

/// Whether a neighbourhood is so wide that its axes are those of the surface under this noise.
bool IsWide(const QuadricDistance& distance, double noise)
{
  return distance.Radius >= LeastRadius * noise;
}

/// sigma_2 and sigma_3, with so many more rings around each vertex that these are wide under the noise
/// that is found with them.
struct WideDeviations
{
  std::array<Deviation, 2> Of{};
  double NarrowShare = 0.0; ///< of vertices whose two rings are not
};

WideDeviations MeasureInWideNeighbourhoods(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const std::vector<int> rings{ 2, 3, 4, 6, 8, 12 };
  const auto distances =
    MeasureDistances(mesh, points, rings, StrideFor(mesh, EnoughWideNeighbourhoods), parallel);
  const std::size_t count = distances[0].size();
  std::vector<double> start = Standardized(distances[3]);
  double noise = DeviationOf(start).Sigma; // that of two rings may be far too small
  WideDeviations found;
  for (int repetition = 0; repetition < 8; ++repetition)
  {
    std::array<std::vector<double>, 2> of;
    std::size_t narrow = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      std::size_t k = 0;
      while (k + 2 < rings.size() && !IsWide(distances[k][i], noise))
      {
        ++k;
      }
      narrow += k > 0 ? 1 : 0;
      of[0].push_back(distances[k][i].Standardized);
      of[1].push_back(distances[k + 1][i].Standardized);
    }
    found = { { DeviationOf(of[0]), DeviationOf(of[1]) },
      static_cast<double>(narrow) / static_cast<double>(count) };
    if (std::abs(found.Of[0].Sigma - noise) <= 0.01 * noise)
    {
      break;
    }
    noise = found.Of[0].Sigma;
  }
  return found;
}

/// f of EstimateCorrelatedNoise().
double ShareOfLevel(double rings)
{
  return std::pow(1.0 + std::pow(4.1 / rings, 2.83), -1.06);
}

/// The noise that may explain sigma_r, by the fit that EstimateCorrelatedNoise() describes.
CorrelatedNoise FitCorrelation(
  const std::vector<int>& rings, const std::vector<Deviation>& deviations, double h)
{
  constexpr Eigen::Index count = 6; // without 16 rings, of which the shape is too large a part
  using Terms = Eigen::Matrix<double, count, 4>;
  double best = LargestMisfit;
  CorrelatedNoise found;
  for (double s = 0.7; s < 8.0; s *= 1.04)
  {
    Terms terms; // over sigma_r^2
    for (Eigen::Index k = 0; k < count; ++k)
    {
      const double r = rings[static_cast<std::size_t>(k)];
      const double sigma = std::max(deviations[static_cast<std::size_t>(k)].Sigma / h, 1e-5);
      const double square = r * r / 144.0;
      terms.row(k) << std::pow(ShareOfLevel(r / s), 2), std::pow(square, 4), std::pow(square, 3),
        1.0;
      terms.row(k) /= sigma * sigma;
    }
    for (unsigned others = 0; others < 8; ++others) // which of the other terms there are
    {
      Terms chosen = terms;
      for (Eigen::Index j = 0; j < 3; ++j)
      {
        chosen.col(j + 1) *= (others >> j) & 1U;
      }
      const Eigen::Vector4d factors =
        chosen.completeOrthogonalDecomposition().solve(Eigen::Matrix<double, count, 1>::Ones());
      const double misfit = ((chosen * factors).array() - 1.0).matrix().norm();
      if (misfit < best && factors.minCoeff() >= 0.0 &&
        (factors[0] * terms.col(0).head<5>()).minCoeff() >= SmallestShare)
      {
        best = misfit;
        found = { std::sqrt(factors[0]) * h, std::sqrt(2.0) * s * h, true };
      }
    }
  }
  const bool isInRange = found.Level > SmallestCorrelated * h && found.Level < LargestUncertain * h;
  return isInRange ? found : CorrelatedNoise();
}

/// The noise in sigma_2 and sigma_3, see EstimateVertexNoise().
double WithoutDetails(const std::array<Deviation, 2>& deviations)
{
  const double two = deviations[0].Sigma;
  const double three = std::max(two, deviations[1].Sigma);
  if (!(two > 0.0))
  {
    return 0.0;
  }
  const double growth = three * three / (two * two) - 1.0;
  const double relative = growth / GrowthOfRoughDetails;
  const double rest = 1.0 - GrowthOfRoughDetails / (GrowthOfDetails - 1.0);
  return two *
    std::sqrt(std::max(
      0.0, 1.0 - growth / (GrowthOfDetails - 1.0) - rest * relative * relative * relative));
}

} // namespace

double QuantileOf(std::vector<double>& values, double fraction)
{
  if (values.empty())
  {
    return 0.0;
  }
  const double place = fraction * static_cast<double>(values.size());
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

double TailOfNormal(std::vector<double>& values)
{
  const double tail = QuantileOf(values, TailFraction) / TailQuantile;
  const double usual = QuantileOf(values, NoiseFraction) / NoiseQuantile;
  return usual > 0.0 ? tail / usual : std::numeric_limits<double>::infinity();
}

double EstimateVertexNoise(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const std::vector<Deviation> deviations =
    MeasureDeviations(mesh, points, { 2, 3 }, StrideFor(mesh, EnoughVertices), parallel);
  if (!deviations[0].IsOfEnough)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double noise = WithoutDetails({ deviations[0], deviations[1] });
  const WideDeviations wide = MeasureInWideNeighbourhoods(mesh, points, parallel);
  const double found = WithoutDetails(wide.Of);
  const bool isNoise =
    wide.NarrowShare > NarrowFraction && found > LeastShareOfNoise * wide.Of[0].Sigma;
  return isNoise ? std::max(noise, found) : noise;
}

CorrelatedNoise EstimateCorrelatedNoise(
  const TriangleMesh& mesh, const Points& points, double given, const ParallelFor& parallel)
{
  if (mesh.NumberOfVertices() < FewestVertices)
  {
    return CorrelatedNoise();
  }
  const std::vector<int> rings{ 2, 3, 4, 6, 8, 12, 16 };
  const std::vector<Deviation> deviations =
    MeasureDeviations(mesh, points, rings, StrideFor(mesh, EnoughWideNeighbourhoods), parallel);
  const bool hasTails = std::all_of(deviations.begin() + 2, deviations.begin() + 5,
    [](const Deviation& deviation) { return deviation.Tail >= SmallestTail * deviation.Sigma; });
  const double h = mesh.MeanEdgeLength();
  if (given > 0.0 && given * given <= 2.0 * deviations[0].Sigma * deviations[0].Sigma)
  {
    return CorrelatedNoise(); // independent noise explains the level
  }
  const double growth = deviations[2].Sigma / deviations[0].Sigma;
  const double last = deviations.back().Sigma;
  const bool hasLevel = growth > LeastGrowth && hasTails &&
    last < LargestLateGrowth * deviations[4].Sigma && last > SmallestCorrelated * h &&
    last < LargestCorrelated * h;
  const bool reachesLevel = given > 0.0 && growth > LeastGrowthToLevel;
  if (!hasLevel && !reachesLevel)
  {
    return given > 0.0 || growth <= LeastGrowth || !hasTails ? CorrelatedNoise()
                                                             : FitCorrelation(rings, deviations, h);
  }
  const double level = given > 0.0 ? given : last;
  std::size_t k = 1;
  while (k + 1 < rings.size() && 2.0 * deviations[k].Sigma * deviations[k].Sigma < level * level)
  {
    ++k;
  }
  // interpolated between the two numbers of rings
  const double below = deviations[k - 1].Sigma * deviations[k - 1].Sigma;
  const double above = deviations[k].Sigma * deviations[k].Sigma;
  const double share =
    above > below ? std::clamp((0.5 * level * level - below) / (above - below), 0.0, 1.0) : 1.0;
  const double radius = rings[k - 1] + share * (rings[k] - rings[k - 1]);
  return { level, radius * h / RadiusOfLength, false };
}

} // namespace SurfaceDiffusion
