// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/FarPoints.h"

#include "Core/Foundation/RobustRange.h"
#include "Core/Geometry/NearestPoints.h"
#include "Run/Surface.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

struct Shift
{
  Eigen::RowVector3d By = Eigen::RowVector3d::Zero();
  double MedianDistance = 0.0; ///< of the moved points
};

/// The shift of points with the least distance from the surface, by Gauss and Newton's method: the
/// distance of each changes along the line to its nearest point (Y. Chen, G. Medioni, Image Vis.
/// Comput. 10, 1992).
Shift FindShift(const Points& places, const Surface& surface)
{
  constexpr int most = 30;
  constexpr Eigen::Index sample = 300;
  constexpr double damping = 1e-3;
  const Triangles triangles = surface.MakeTriangles();
  const NearestPoints nearest(surface.Points(), triangles);
  const Eigen::Index stride = (places.rows() + sample - 1) / sample;
  Shift best;
  Shift shift;
  for (int iteration = 0; iteration < most; ++iteration)
  {
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<double> distances;
    for (Eigen::Index i = 0; i < places.rows(); i += stride)
    {
      const Eigen::RowVector3d x = places.row(i) + shift.By;
      const NearestPoint found = nearest.Find(x);
      Eigen::RowVector3d step = -x;
      for (std::size_t a = 0; a < 3; ++a)
      {
        step += found.Coordinates[a] *
          surface.Points().row(triangles(found.Triangle, static_cast<Eigen::Index>(a)));
      }
      distances.push_back(step.norm());
      if (distances.back() > 0.0)
      {
        normals += step.transpose() * step / step.squaredNorm();
        sum += step.transpose();
      }
    }
    normals.diagonal().array() += damping * static_cast<double>(distances.size());
    shift.MedianDistance = Median(distances);
    if (iteration == 0 || shift.MedianDistance < best.MedianDistance)
    {
      best = shift;
    }
    shift.By += normals.ldlt().solve(sum).transpose();
  }
  return best;
}

} // namespace

Sentence DescribeFarPoints(const char* kind, const Points& places,
  const std::vector<double>& distances, const Surface& surface, bool canLeaveOut)
{
  constexpr double edges = 5.0;
  constexpr double least = 0.02; // of the diagonal
  constexpr double most = 0.1;
  constexpr double strange = 0.25;
  const double diagonal = DiagonalOf(surface.Points(), Reduction::Serial());
  const double edge = surface.Mesh().MeanEdgeLength() * surface.Mesh().LengthUnit();
  const double reach = std::min(std::max(edges * edge, least * diagonal), most * diagonal);
  const auto far = std::count_if(
    distances.begin(), distances.end(), [&](double distance) { return distance > reach; });
  if (far == 0)
  {
    return {};
  }
  std::vector<double> sorted = distances;
  const double median = Median(sorted);
  Sentence text;
  text << far << " of " << distances.size() << " points " << kind << (far == 1 ? " is" : " are")
       << " farther than " << reach << " from the surface, which is " << diagonal
       << " large; median distance " << median << ", largest "
       << *std::max_element(distances.begin(), distances.end());
  if (median > strange * diagonal)
  {
    text << "; their unit or origin may be another";
  }
  constexpr std::size_t fewest = 8; // for three unknowns
  constexpr double share = 0.2; // of the distance, which a shift leaves
  if (surface.Mesh().NumberOfTriangles() > 0 && distances.size() >= fewest &&
    2 * static_cast<std::size_t>(far) > distances.size())
  {
    const Shift shift = FindShift(places, surface);
    if (shift.MedianDistance < share * median)
    {
      text << "; a shift by (" << shift.By[0] << ", " << shift.By[1] << ", " << shift.By[2]
           << ") would bring them to it, as another origin of coordinates needs";
    }
  }
  if (canLeaveOut)
  {
    text << " (set " << Word::Setting("MaximumDistance") << " to leave out those beyond it)";
  }
  return text;
}

void ReportDistances(
  const Surface& surface, const KnownValues& known, double maximumDistance, RunResult& result)
{
  std::vector<double> sorted = known.SampleDistances;
  const double median = Median(sorted);
  const double largest = sorted.empty() ? 0.0 : *std::max_element(sorted.begin(), sorted.end());
  result.AddNumber("MedianDistance", median);
  result.Numbers.push_back(Output::OfNumber("LargestDistance", largest, Combination::Largest));
  const Sentence text = maximumDistance == 0.0
    ? DescribeFarPoints("with values", known.SamplePlaces, known.SampleDistances, surface)
    : Sentence();
  if (!text.Words().empty())
  {
    result.WarnOnce(text);
  }
}

} // namespace SurfaceDiffusion
