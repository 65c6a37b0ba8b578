// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/QuadraticFits.h"

#include "Core/Foundation/IndexLists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

/// By which b is multiplied in norms.
const double RootOfTwo = std::sqrt(2.0);

constexpr double SteepestCosine = 0.5; ///< of the largest angle of normals

/// The place of an entry; -1 if there is none.
std::ptrdiff_t PlaceOf(Index entry, const std::vector<Index>& ascending)
{
  const auto found = std::lower_bound(ascending.begin(), ascending.end(), entry);
  return found != ascending.end() && *found == entry ? found - ascending.begin() : -1;
}

} // namespace

/// The search does not pass vertices of many triangles, such as the middle of a disc that is cut
/// into slices.
void QuadraticFits::FindDisk()
{
  constexpr Index manyTriangles = 32;
  const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
  const auto addNeighbours = [&](Index i)
  {
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      for (int step = 1; step <= 2; ++step)
      {
        this->Disk.push_back(this->Mesh.OtherCorner(this->Mesh.VertexCorners()[c], step));
      }
    }
  };
  this->Disk.clear();
  addNeighbours(this->Centre);
  SortUnique(this->Disk, 0);
  this->Ring = this->Disk;
  for (const Index i : this->Ring)
  {
    if (this->Ring.size() <= static_cast<std::size_t>(manyTriangles) &&
      begin[i + 1] - begin[i] <= manyTriangles)
    {
      addNeighbours(i);
    }
  }
  SortUnique(this->Disk, 0);
  const std::ptrdiff_t own = PlaceOf(this->Centre, this->Disk);
  if (own >= 0)
  {
    this->Disk.erase(this->Disk.begin() + own);
  }
}

/// Of the normals of the disk with that of the vertex. On surfaces with one side those of neighbours
/// may have the other sign.
std::vector<double> QuadraticFits::CosinesOfNormals() const
{
  std::vector<double> sides(this->Disk.size(), 1.0);
  if (this->Normals.IsOnOneSide(this->Centre))
  {
    sides.assign(sides.size(), 0.0);
    const auto pass = [&](Index i, double side)
    {
      for (Index k = this->Mesh.VertexCornersBegin()[i]; k < this->Mesh.VertexCornersBegin()[i + 1];
           ++k)
      {
        const Index corner = this->Mesh.VertexCorners()[k];
        for (int a = 0; a < 3; ++a)
        {
          const Index other = corner - corner % 3 + a;
          const std::ptrdiff_t place =
            PlaceOf(this->Mesh.TriangleVertices().data()[other], this->Disk);
          if (place >= 0 && sides[place] == 0.0)
          {
            sides[place] = side * this->Normals.SideOf(corner) * this->Normals.SideOf(other);
          }
        }
      }
    };
    pass(this->Centre, 1.0);
    const std::vector<double> ofRing = sides;
    for (std::size_t k = 0; k < ofRing.size(); ++k)
    {
      if (ofRing[k] != 0.0)
      {
        pass(this->Disk[k], ofRing[k]);
      }
    }
  }
  for (std::size_t k = 0; k < sides.size(); ++k)
  {
    sides[k] *=
      this->Normals.OfVertices.row(this->Disk[k]).dot(this->Normals.OfVertices.row(this->Centre));
  }
  return sides;
}

bool QuadraticFits::MoveTo(Index vertex)
{
  this->Centre = vertex;
  this->Determined = false;
  this->Sharp = false;
  const Eigen::Vector3d normal = this->Normals.OfVertices.row(vertex).transpose();
  if (!(normal.norm() > 0.0))
  {
    return false;
  }
  this->Plane.col(0) = normal.unitOrthogonal();
  this->Plane.col(1) = normal.cross(this->Plane.col(0));
  this->FindDisk();
  const std::vector<double> cosines = this->CosinesOfNormals();
  bool isFitted = false;
  for (const bool withRing : { false, true })
  {
    this->Chosen.clear();
    for (std::size_t k = 0; k < this->Disk.size(); ++k)
    {
      const bool isNeighbour = PlaceOf(this->Disk[k], this->Ring) >= 0;
      const bool isReached = cosines[k] > SteepestCosine;
      this->Sharp = this->Sharp || (isNeighbour && !isReached);
      if (isReached || (withRing && isNeighbour))
      {
        this->Chosen.push_back(this->Disk[k]);
      }
    }
    isFitted = this->Decompose();
    if (this->Determined || !this->Sharp)
    {
      break;
    }
  }
  return isFitted;
}

bool QuadraticFits::Decompose()
{
  const auto count = static_cast<Eigen::Index>(this->Chosen.size());
  Eigen::Matrix<double, Eigen::Dynamic, 5> rows(count, 5);
  this->Unit = 0.0;
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const Eigen::RowVector3d d =
      this->Positions.row(this->Chosen[k]) - this->Positions.row(this->Centre);
    rows.row(k).head<2>() = d * this->Plane;
    this->Unit = std::max(this->Unit, rows.row(k).head<2>().norm());
  }
  if (!(this->Unit > 0.0))
  {
    return false;
  }
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const double x = rows(k, 0) / this->Unit;
    const double y = rows(k, 1) / this->Unit;
    rows.row(k) << x, y, 0.5 * x * x, x * y, 0.5 * y * y;
  }
  // The pivots of a decomposition depend on the axes, singular values do not.
  constexpr double surelyRegular = 1e-4;
  constexpr double singular = 1e-6;
  this->Regular.setThreshold(surelyRegular);
  this->Regular.compute(rows);
  this->Determined = this->Regular.rank() == 5;
  if (!this->Determined)
  {
    rows.col(3) /= RootOfTwo;
    this->Least.setThreshold(singular);
    this->Least.compute(rows, Eigen::ComputeThinU | Eigen::ComputeThinV);
    this->Determined = this->Least.rank() == 5;
  }
  return true;
}

QuadraticFits::Coefficients QuadraticFits::Fit(const Vector& differences) const
{
  if (this->Regular.rank() == 5)
  {
    return this->Regular.solve(differences);
  }
  Coefficients found = this->Least.solve(differences);
  found[3] /= RootOfTwo;
  return found;
}

double QuadraticFits::ErrorOfSecondOrder() const
{
  const auto count = static_cast<Eigen::Index>(this->Chosen.size());
  const auto squareOf = [](const Coefficients& c)
  { return c[2] * c[2] + 2.0 * c[3] * c[3] + c[4] * c[4]; };
  double sum = squareOf(this->Fit(Vector::Ones(count)));
  // The sum over all unit vectors is that over an orthonormal basis of what fits can represent.
  const Eigen::MatrixXd basis = this->Regular.rank() == 5
    ? Eigen::MatrixXd(this->Regular.householderQ() * Eigen::MatrixXd::Identity(count, 5))
    : this->Least.matrixU();
  for (const auto& column : basis.colwise())
  {
    sum += squareOf(this->Fit(column));
  }
  return std::sqrt(sum);
}

/// g^ij (u_ij - G^k_ij u_k) with the metric g = I + grad f grad f^T of the graph of f, for which
/// G^k_ij = f_k f_ij/(1 + |grad f|^2).
double QuadraticFits::LaplacianOf(const Coefficients& u) const
{
  const Coefficients f = this->Fit(this->Depths() / this->Unit);
  const double w = 1.0 + f.head<2>().squaredNorm();
  const auto traceOf = [&](const Coefficients& of)
  {
    return of[2] + of[4] -
      (f[0] * f[0] * of[2] + 2.0 * f[0] * f[1] * of[3] + f[1] * f[1] * of[4]) / w;
  };
  return (traceOf(u) - f.head<2>().dot(u.head<2>()) / w * traceOf(f)) / (this->Unit * this->Unit);
}

double QuadraticFits::DepthOf(Index j) const
{
  const Eigen::Vector3d d =
    (this->Positions.row(j) - this->Positions.row(this->Centre)).transpose();
  return -d.dot(this->Normals.OfVertices.row(this->Centre).transpose());
}

Vector QuadraticFits::Depths() const
{
  Vector depths(static_cast<Eigen::Index>(this->Chosen.size()));
  for (Eigen::Index k = 0; k < depths.size(); ++k)
  {
    depths[k] = this->DepthOf(this->Chosen[k]);
  }
  return depths;
}

double QuadraticFits::CurvatureOfNeighbours() const
{
  double low = 0.0;
  double high = 0.0;
  double product = 0.0;
  double square = 0.0;
  for (const Index j : this->Ring)
  {
    const double depth = this->DepthOf(j);
    const double half = 0.5 *
      ((this->Positions.row(j) - this->Positions.row(this->Centre)) * this->Plane).squaredNorm();
    low = std::min(low, depth);
    high = std::max(high, depth);
    product += depth * half;
    square += half * half;
  }
  return (low < 0.0 && high > 0.0) || !(square > 0.0) ? 0.0 : product / square;
}

} // namespace SurfaceDiffusion
