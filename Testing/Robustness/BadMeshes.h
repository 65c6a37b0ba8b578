// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <cmath>
#include <string>
#include <vector>

/// Surfaces with one defect each.
namespace SurfaceDiffusion::Testing
{

/// Klein bottle in figure-eight immersion: closed, one-sided, crossing itself. around and across
/// must be even.
inline Surface KleinBottle(Index around, Index across)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Index> number;
  for (Index j = 0; j <= across; ++j)
  {
    for (Index i = 0; i <= around; ++i)
    {
      // After one turn the section is rotated by half a turn and meets its start reversed.
      const Index section = (i < around ? j : across - j) % across;
      number.push_back(section * around + i % around);
      if (i < around && j < across)
      {
        const double p = 2.0 * Pi * i / around;
        const double q = 2.0 * Pi * j / across;
        const double r = std::cos(0.5 * p) * std::sin(q) - std::sin(0.5 * p) * std::sin(2.0 * q);
        vertices.emplace_back((3.0 + r) * std::cos(p), (3.0 + r) * std::sin(p),
          std::sin(0.5 * p) * std::sin(q) + std::cos(0.5 * p) * std::sin(2.0 * q));
      }
    }
  }
  auto faces = GridFaces(around, across);
  Renumber(faces, number);
  return MakeSurface(vertices, faces);
}

/// The pages of a book: `pages` squares that share one edge.
inline Surface Book(int pages)
{
  std::vector<Eigen::RowVector3d> vertices = { { 0, 0, 0 }, { 0, 0, 1 } };
  std::vector<std::array<Index, 3>> faces;
  for (int page = 0; page < pages; ++page)
  {
    const double angle = 2.0 * Pi * page / pages;
    const Index a = static_cast<Index>(vertices.size());
    vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    vertices.emplace_back(std::cos(angle), std::sin(angle), 1.0);
    faces.insert(faces.end(), { { 0, a, a + 1 }, { 0, a + 1, 1 } });
  }
  return MakeSurface(vertices, faces);
}

/// A disk with a row of needle triangles, one of which has an angle of `degrees`.
inline Surface Needles(double degrees)
{
  Surface s = Disk(6);
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    vertices.push_back(s.Vertices.row(i));
  }
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const Index a = s.Faces(t, 0), b = s.Faces(t, 1), c = s.Faces(t, 2);
    if (t % 7 != 3)
    {
      faces.push_back({ a, b, c });
      continue;
    }
    // A vertex so near the edge ab that the angles at a and b are as small as required.
    const Eigen::RowVector3d middle = 0.5 * (vertices[a] + vertices[b]);
    const double height = 0.5 * (vertices[b] - vertices[a]).norm() * std::tan(degrees * Pi / 180.0);
    const Index d = static_cast<Index>(vertices.size());
    vertices.push_back(middle + height * (vertices[c] - middle).normalized());
    faces.insert(faces.end(), { { a, b, d }, { b, c, d }, { c, a, d } });
  }
  return MakeSurface(vertices, faces);
}

/// A spiral of triangles that grow from `low` to `high`.
inline Surface Spiral(double low, double high, Index steps)
{
  std::vector<Eigen::RowVector3d> vertices = { { 0, 0, 0 } };
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i <= steps; ++i)
  {
    const double exponent = std::log10(low) + (std::log10(high) - std::log10(low)) * i / steps;
    const double r = std::pow(10.0, exponent);
    vertices.emplace_back(r * std::cos(i), r * std::sin(i), 0.0);
    if (i > 0)
    {
      faces.push_back({ std::max<Index>(0, i - 1), i, i + 1 });
    }
  }
  return MakeSurface(vertices, faces);
}

struct NamedSurface
{
  std::string Name;
  Surface Shape;
  bool InSinglePrecision = false; ///< coordinates as float
};

inline std::vector<NamedSurface> BadMeshes()
{
  std::vector<NamedSurface> family = {
    { "ThreeFins", ThreeFins(6) },
    { "BookOfSeven", Book(7) },
    { "MoebiusStrip", Moebius(30, 4) },
    { "KleinBottle", KleinBottle(30, 16) },
    { "OneTriangle", MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } }) },
    { "TwoTrianglesAtOneVertex",
      MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 } },
        { { 0, 1, 2 }, { 0, 3, 4 } }) },
    { "TwoIntersectingSpheres", Joined(Icosphere(2), Moved(Icosphere(2), { 0.5, 0.0, 0.0 })) },
    { "FarFromTheOrigin", Moved(Icosphere(3), { 1e6, -1e6, 1e6 }) },
    { "FarFromTheOriginInFloat", Moved(Icosphere(3), { 1e6, -1e6, 1e6 }), true },
    { "CoordinatesOfManySizes", Spiral(1e-150, 1e150, 400) },
  };
  for (const double degrees : { 1e-2, 1e-4, 1e-6, 1e-8, 1e-10 })
  {
    family.push_back(
      { "NeedlesOf1em" + std::to_string(std::lround(-std::log10(degrees))) + "Degrees",
        Needles(degrees) });
  }
  for (const int power : { -150, -50, 50, 150 })
  {
    family.push_back(
      { std::string("SizeOf1e") + (power < 0 ? "m" : "") + std::to_string(std::abs(power)),
        Scaled(Icosphere(2), std::pow(10.0, power)) });
  }

  Surface cones = Joined(Moved(Disk(4), { 0, 0, 1 }), Moved(Disk(4), { 0, 0, -1 }));
  for (Index i = 0; i < cones.NumberOfVertices(); ++i) // both centres become one vertex
  {
    cones.Vertices(i, 2) *= cones.Vertices.row(i).head(2).norm();
  }
  const Index second = cones.NumberOfVertices() / 2;
  cones.Faces = cones.Faces.unaryExpr([&](Index v) { return v == second ? 0 : v; }).eval();
  family.push_back({ "TwoConesAtOneVertex", cones });

  Surface twice = Icosphere(2);
  const Index count = twice.NumberOfTriangles();
  twice.Faces = twice.Faces.replicate(2, 1).eval();
  family.push_back({ "EveryTriangleTwice", twice });
  twice.Faces.bottomRows(count).col(1).swap(twice.Faces.bottomRows(count).col(2));
  family.push_back({ "EveryTriangleTwiceTurned", twice });

  Surface mixed = Icosphere(3);
  for (Index t = 0; t < mixed.NumberOfTriangles(); t += 3)
  {
    std::swap(mixed.Faces(t, 1), mixed.Faces(t, 2));
  }
  family.push_back({ "MixedOrientation", mixed });

  Surface isolated = Icosphere(2);
  isolated.Vertices.conservativeResize(isolated.NumberOfVertices() + 1000, 3);
  isolated.Vertices.bottomRows(1000).setConstant(2.0);
  family.push_back({ "AThousandIsolatedVertices", isolated });

  Surface flat = Icosphere(2); // some triangles have all corners at one place or on one line
  for (Index t = 0; t < flat.NumberOfTriangles(); t += 10)
  {
    flat.Vertices.row(flat.Faces(t, 0)) = flat.Vertices.row(flat.Faces(t, 1));
  }
  family.push_back({ "TrianglesOfZeroArea", flat });
  family.push_back({ "NoArea",
    MakeSurface({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 0, 0 } },
      { { 0, 1, 2 }, { 1, 2, 3 }, { 3, 3, 3 } }) });
  return family;
}

} // namespace SurfaceDiffusion::Testing
