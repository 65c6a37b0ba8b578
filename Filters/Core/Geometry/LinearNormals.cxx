// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/LinearNormals.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Normals with less support are outliers. The flat side of a corner of a cube has about 0.3.
constexpr double LeastSupport = 0.15;
/// e of FitLinearNormals(): gradients across one row of triangles are not determined by the fit.
constexpr double RidgeOfFit = 0.05;

double RangeFactor(const NormalFilterSettings& settings)
{
  return 0.5 / (settings.Range * settings.Range);
}

/// The share of the area of the ring that agrees with each normal.
Vector MeasureSupport(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const double range = RangeFactor(settings);
  Vector support(graph.NumberOfFaces());
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      double like = 0.0;
      double all = 0.0;
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        const double difference = (geometry.Normals.row(g) - geometry.Normals.row(f)).squaredNorm();
        like += geometry.Areas[g] * FallOff(range * difference);
        all += geometry.Areas[g];
      }
      support[f] = all > 0.0 ? like / all : 1.0;
    });
  return support;
}

/// So many triangles are fitted side by side, in single precision: enough for normals and weights.
constexpr int Slice = 8;
using Lane = float[Slice];

/// One neighbour of each triangle of a slice.
struct Neighbours
{
  Lane Offset[3]; ///< of the centroid, over the width of the triangle
  Lane Difference[3]; ///< of the guide
  Lane Width; ///< over that of the triangle
  Lane Normal[3];
  Lane Area; ///< 0: there is no such neighbour
};

/// The normal equations of the fits of a slice: sums of the weighted terms.
struct LinearFits
{
  Lane W, X, Y, XX, XY, YY;
  Lane V[3], VX[3], VY[3];
};

/// Add neighbour after neighbour. The axes of the fits are those of T. Duff et al., Building an
/// Orthonormal Basis, Revisited, JCGT 6(1), 2017.
SURFACEDIFFUSION_ANY_VECTORS void AddNeighbours(const Neighbours* neighbours, std::size_t count,
  const Lane* guide, float distanceFactor, float rangeFactor, LinearFits& result)
{
  LinearFits fits = result; // which the compiler knows to be apart
  Lane first[3];
  Lane second[3];
  for (int l = 0; l < Slice; ++l)
  {
    const float x = guide[0][l];
    const float y = guide[1][l];
    const float sign = guide[2][l] < 0.0F ? -1.0F : 1.0F;
    const float a = -1.0F / (sign + guide[2][l]);
    first[0][l] = 1.0F + sign * x * x * a;
    first[1][l] = sign * x * y * a;
    first[2][l] = -sign * x;
    second[0][l] = x * y * a;
    second[1][l] = sign + y * y * a;
    second[2][l] = -y;
  }
  for (std::size_t k = 0; k < count; ++k)
  {
    const Neighbours& n = neighbours[k];
    Lane w, x, y, wx, wy;
    for (int l = 0; l < Slice; ++l)
    {
      const float dx = n.Offset[0][l];
      const float dy = n.Offset[1][l];
      const float dz = n.Offset[2][l];
      const float mx = n.Difference[0][l];
      const float my = n.Difference[1][l];
      const float mz = n.Difference[2][l];
      w[l] = Fade(distanceFactor * (dx * dx + dy * dy + dz * dz) / n.Width[l] +
        rangeFactor * (mx * mx + my * my + mz * mz));
      x[l] = first[0][l] * dx + first[1][l] * dy + first[2][l] * dz;
      y[l] = second[0][l] * dx + second[1][l] * dy + second[2][l] * dz;
    }
    for (int l = 0; l < Slice; ++l)
    {
      w[l] = n.Area[l] * EighthPower(w[l]);
      wx[l] = w[l] * x[l];
      wy[l] = w[l] * y[l];
    }
    for (int l = 0; l < Slice; ++l)
    {
      fits.W[l] += w[l];
      fits.X[l] += wx[l];
      fits.Y[l] += wy[l];
      fits.XX[l] += wx[l] * x[l];
      fits.XY[l] += wx[l] * y[l];
      fits.YY[l] += wy[l] * y[l];
    }
    for (int c = 0; c < 3; ++c)
    {
      for (int l = 0; l < Slice; ++l)
      {
        fits.V[c][l] += w[l] * n.Normal[c][l];
        fits.VX[c][l] += wx[l] * n.Normal[c][l];
        fits.VY[c][l] += wy[l] * n.Normal[c][l];
      }
    }
  }
  result = fits;
}

/// The direction of the value at the offset 0, not normalised: by Cramer's rule without the
/// determinant, which is not negative.
Eigen::RowVector3d Solve(const LinearFits& fits, int l)
{
  const Eigen::RowVector3d v(fits.V[0][l], fits.V[1][l], fits.V[2][l]);
  const double ridge = RidgeOfFit * (static_cast<double>(fits.XX[l]) + fits.YY[l]);
  if (!(ridge > 0.0))
  {
    return v;
  }
  // in the unit of length in which the mean square of the offsets is 1 / RidgeOfFit
  const double unit = std::sqrt(ridge / fits.W[l]);
  const double x = fits.X[l] / unit / fits.W[l];
  const double y = fits.Y[l] / unit / fits.W[l];
  const double xx = fits.XX[l] / ridge + 1.0;
  const double xy = fits.XY[l] / ridge;
  const double yy = fits.YY[l] / ridge + 1.0;
  const Eigen::RowVector3d vx(fits.VX[0][l], fits.VX[1][l], fits.VX[2][l]);
  const Eigen::RowVector3d vy(fits.VY[0][l], fits.VY[1][l], fits.VY[2][l]);
  return (xx * yy - xy * xy) * v + (y * xy - x * yy) / unit * vx + (x * xy - y * xx) / unit * vy;
}

/// Fits the slices of a surface.
class SliceFitter
{
public:
  SliceFitter(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
    const NormalFilterSettings& settings)
    : Graph(graph)
    , Geometry(geometry)
    , Guide(guide)
    , DistanceFactor(static_cast<float>(0.5 / (settings.Width * settings.Width)))
    , Range(RangeFactor(settings))
  {
  }

  /// The normals of triangles `begin` to `end`, at most Slice of them.
  void Fit(Index begin, Index end, Points& normals)
  {
    this->List.clear();
    this->Fits = LinearFits();
    for (Index f = begin; f < end; ++f)
    {
      this->Gather(f, f - begin);
    }
    AddNeighbours(this->List.data(), this->List.size(), this->Guides, this->DistanceFactor,
      static_cast<float>(this->Range), this->Fits);
    for (Index f = begin; f < end; ++f)
    {
      const Eigen::RowVector3d normal = Solve(this->Fits, f - begin);
      const double length = normal.norm();
      normals.row(f) = length > 0.0 && !this->Guide.row(f).isZero(0.0)
        ? Eigen::RowVector3d(normal / length)
        : Eigen::RowVector3d(this->Guide.row(f));
    }
  }

private:
  void Gather(Index f, int l)
  {
    const Offset begin = this->Graph.Ring.Begin[f];
    const auto count = static_cast<std::size_t>(this->Graph.Ring.Begin[f + 1] - begin);
    this->List.resize(std::max(this->List.size(), count));
    const double width = this->Geometry.Widths[f];
    const double scale = width > 0.0 ? 1.0 / width : 0.0;
    for (std::size_t k = 0; k < count; ++k)
    {
      const Index g = this->Graph.Ring.Entries[begin + k];
      Neighbours& n = this->List[k];
      for (int c = 0; c < 3; ++c)
      {
        n.Offset[c][l] = static_cast<float>(
          scale * (this->Geometry.Centroids(g, c) - this->Geometry.Centroids(f, c)));
        n.Difference[c][l] = static_cast<float>(this->Guide(g, c) - this->Guide(f, c));
        n.Normal[c][l] = static_cast<float>(this->Geometry.Normals(g, c));
      }
      n.Width[l] = static_cast<float>(scale * this->Geometry.Widths[g]);
      n.Area[l] = static_cast<float>(this->Geometry.Areas[g]);
    }
    // its own normal, at the offset 0
    const double difference = (this->Geometry.Normals.row(f) - this->Guide.row(f)).squaredNorm();
    const double weight = this->Geometry.Areas[f] * FallOff(this->Range * difference);
    this->Fits.W[l] = static_cast<float>(weight);
    for (int c = 0; c < 3; ++c)
    {
      this->Guides[c][l] = static_cast<float>(this->Guide(f, c));
      this->Fits.V[c][l] = static_cast<float>(weight * this->Geometry.Normals(f, c));
    }
  }

  const FaceGraph& Graph;
  const FaceGeometry& Geometry;
  const Points& Guide;
  const float DistanceFactor; ///< 1 / (2 Width^2)
  const double Range; ///< 1 / (2 Range^2)
  std::vector<Neighbours> List;
  Lane Guides[3] = {};
  LinearFits Fits = {};
};

} // namespace

Points ReplaceUnsupportedNormals(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const Vector support = MeasureSupport(graph, geometry, settings, parallel);
  Points guide = geometry.Normals;
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      Index best = f;
      for (Offset k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
      {
        const Index g = graph.Across.Entries[k];
        best = support[g] > support[best] ? g : best;
      }
      if (support[f] < LeastSupport)
      {
        guide.row(f) = geometry.Normals.row(best);
      }
    });
  return guide;
}

Points FitLinearNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  Points normals(graph.NumberOfFaces(), 3);
  ForEachBlock(parallel, graph.NumberOfFaces(),
    [&](Index, Index begin, Index end)
    {
      SliceFitter fitter(graph, geometry, guide, settings);
      for (Index f = begin; f < end; f += Slice)
      {
        fitter.Fit(f, std::min(f + Slice, end), normals);
      }
    });
  return normals;
}

} // namespace SurfaceDiffusion
