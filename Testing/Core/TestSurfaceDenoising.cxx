// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockParts.h"
#include "Core/Geometry/FaceFlips.h"
#include "Core/Geometry/InnerEdges.h"
#include "Core/Geometry/LinearNormals.h"
#include "Core/Geometry/TriangleOrientation.h"
#include "Core/Geometry/VertexFans.h"
#include "Core/Geometry/VertexNoise.h"
#include "DenoisedSurfaces.h"
#include "Hubs.h"
#include "Interpolation.h"
#include "Meshes.h"
#include "NoisySurfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <tuple>
#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Of the mean edge length: the variation of normals is minimised in single precision.
constexpr double Rounding = 1e-6;

/// A flat surface in the plane z = 0 with its faces.
struct FlatSurface
{
  FlatSurface()
    : Grid(Strip(20, 16, 2.0, 1.6))
    , Mesh(this->Grid.Vertices, this->Grid.Faces)
    , Graph(this->Mesh)
    , Place(GatherVertices(this->Mesh, this->Grid.Vertices) / this->Mesh.LengthUnit())
  {
    this->Geometry.Measure(this->Mesh, this->Place, SerialFor());
    this->Geometry.MeasureWidths(this->Graph, SerialFor());
  }

  Surface Grid;
  TriangleMesh Mesh;
  FaceGraph Graph;
  Points Place; ///< of the vertices
  FaceGeometry Geometry;
};

} // namespace

TEST(SurfaceDenoising, NoisyBlockRegainsItsPlanesAndSharpEdges)
{
  const Surface block = LBlock(24);
  for (const double amount : { 0.1, 0.3, 0.4 })
  {
    const Surface noisy = NoisyAlongNormals(block, amount);
    DenoisingReport report;
    const Surface result = Denoised(noisy, DenoisingSettings(), {}, &report);
    EXPECT_EQ(report.Type, SurfaceType::CAD);
    EXPECT_GT(MeanAngle(noisy, block), 80.0 * amount);
    EXPECT_LT(MeanAngle(result, block), 0.25 + 2.5 * amount) << "noise " << amount;
    EXPECT_NEAR(Volume(result) / Volume(block), 1.0, 0.005);
    EXPECT_LE(NumberOfFlippedFaces(result, block), NumberOfFlippedFaces(noisy, block));
  }
}

/// Without the final fit, 0.05 h leave 1.4 degrees.
TEST(SurfaceDenoising, LessNoiseOfABlockLeavesSmallerAngles)
{
  const Surface block = LBlock(24);
  double last = 0.0;
  for (const auto& [amount, largest] : { std::pair(0.05, 0.3), { 0.1, 0.4 }, { 0.2, 0.7 } })
  {
    const double angle = MeanAngle(Denoised(NoisyAlongNormals(block, amount)), block);
    EXPECT_LT(angle, largest) << "noise " << amount;
    EXPECT_GT(angle, last) << "noise " << amount;
    last = angle;
  }
}

/// The type of a surface may change between two levels of noise, which the slack allows for.
TEST(SurfaceDenoising, LessNoiseLeavesSmallerAngles)
{
  for (const Surface& surface : { Icosphere(4), Torus(80, 40), Cylinder(40, 30), LBlock(16) })
  {
    double last = 0.0;
    for (const double amount : { 0.015, 0.03, 0.06, 0.12, 0.24 })
    {
      const Surface noisy = NoisyAlongNormals(surface, amount);
      const double angle = MeanAngle(Denoised(noisy), surface);
      EXPECT_LT(angle, 0.95 * MeanAngle(noisy, surface)) << "noise " << amount;
      EXPECT_GT(angle, last - 0.2) << "noise " << amount;
      last = std::max(last, angle);
    }
  }
}

namespace
{

/// A strip with waves of many lengths, the shortest as long as a few triangles, as scans have.
Surface RoughWaves()
{
  Surface waves = Strip(80, 60, 8.0, 6.0);
  for (Index i = 0; i < waves.NumberOfVertices(); ++i)
  {
    const auto p = waves.Vertices.row(i);
    for (int k = 0; k < 5; ++k)
    {
      const double wave = 4.0 * std::pow(1.6, k);
      waves.Vertices(i, 2) += 0.5 * std::pow(wave, -1.4) *
        (std::sin(wave * p[0] + k) + std::sin(wave * p[1] + 2.0 * k) +
          std::sin(0.7 * wave * (p[0] - p[1]) + 3.0 * k));
    }
  }
  return waves;
}

} // namespace

TEST(SurfaceDenoising, RoughDetailsAreNoNoise)
{
  const Surface waves = RoughWaves();
  EXPECT_EQ(LargestDistance(Denoised(waves), waves), 0.0);
}

/// They leave 7.8 and 11.6 degrees; steps that end at a whiteness of 1 leave 9.4 and 12.1, and those
/// that end by the mean square alone 14.8 under the second noise.
TEST(SurfaceDenoising, StepsEndBeforeTheyRemoveDetails)
{
  const Surface waves = RoughWaves();
  for (const auto& [amount, largest] : { std::pair(0.1, 8.4), { 0.3, 11.9 } })
  {
    DenoisingSettings settings;
    settings.NoiseLevel = amount * MeanEdgeLength(waves);
    settings.Type = SurfaceType::Organic;
    EXPECT_LT(MeanAngle(Denoised(NoisyAlongNormals(waves, amount), settings), waves), largest);
  }
}

/// They leave 1.63, 1.41 and 2.54 degrees; careful steps alone leave 2.22, 1.89 and 2.81, and those
/// that end by the mean square alone 3.36 on the last.
TEST(SurfaceDenoising, WholeStepsAreKeptWhereTheyRemoveNoDetails)
{
  for (const auto& [surface, largest] :
    { std::pair(Torus(120, 60), 1.8), { Icosphere(5), 1.6 }, { HalfRoughTorus(120), 2.65 } })
  {
    DenoisingSettings settings;
    settings.NoiseLevel = 0.3 * MeanEdgeLength(surface);
    settings.Type = SurfaceType::Organic;
    EXPECT_LT(MeanAngle(Denoised(NoisyAlongNormals(surface, 0.3), settings), surface), largest);
  }
}

TEST(SurfaceDenoising, ImpulsiveNoiseOfABlockIsRemoved)
{
  const Surface block = LBlock(24);
  const Surface noisy = NoisyAlongNormals(block, 0.5, 0.5);
  const Surface result = Denoised(noisy);
  EXPECT_GT(MeanAngle(noisy, block), 20.0);
  EXPECT_LT(MeanAngle(result, block), 1.0);
}

TEST(SurfaceDenoising, SphereAndTorusAreNoOrganicSurfacesAndBecomeSmooth)
{
  for (const auto& [surface, angle] : { std::pair(Icosphere(5), 0.6), { Torus(80, 40), 1.8 } })
  {
    const Surface noisy = NoisyAlongNormals(surface, 0.3);
    DenoisingReport report;
    const Surface result = Denoised(noisy, DenoisingSettings(), {}, &report);
    EXPECT_EQ(report.Type, SurfaceType::CAD);
    EXPECT_GT(MeanAngle(noisy, surface), 25.0);
    EXPECT_LT(MeanAngle(result, surface), angle);
    EXPECT_NEAR(Volume(result) / Volume(surface), 1.0, 0.005);
  }
}

TEST(SurfaceDenoising, SurfacesWithDetailsOfAFewTrianglesAreOrganic)
{
  const Surface rough = RoughTorus(120);
  const Surface noisy = NoisyAlongNormals(rough, 0.3);
  DenoisingReport report;
  const double angle = MeanAngle(Denoised(noisy, DenoisingSettings(), {}, &report), rough);
  EXPECT_EQ(report.Type, SurfaceType::Organic);
  DenoisingSettings asCad;
  asCad.Type = SurfaceType::CAD;
  EXPECT_LT(angle, MeanAngle(Denoised(noisy, asCad), rough));
}

/// With one end for all points, 0.1 h leave 2.3 and 2.1 degrees.
TEST(SurfaceDenoising, RoughPartsKeepTheirDetailsAndSmoothOnesBecomeSmooth)
{
  const Surface surface = HalfRoughTorus(120);
  const auto place = [&](Index t)
  {
    return (surface.Vertices(surface.Faces(t, 0), 0) + surface.Vertices(surface.Faces(t, 1), 0) +
             surface.Vertices(surface.Faces(t, 2), 0)) /
      3.0;
  };
  for (const auto& [amount, rough, smooth] :
    { std::tuple(0.1, 2.25, 1.2), { 0.2, 3.3, 1.7 }, { 0.3, 4.2, 2.5 } })
  {
    DenoisingReport report;
    const Surface result =
      Denoised(NoisyAlongNormals(surface, amount), DenoisingSettings(), {}, &report);
    EXPECT_EQ(report.Type, SurfaceType::Organic);
    EXPECT_LT(MeanAngle(result, surface, [&](Index t) { return place(t) > 0.5; }), rough);
    EXPECT_LT(MeanAngle(result, surface, [&](Index t) { return place(t) < -0.2; }), smooth);
  }
}

namespace
{

/// Gaussian noise in each coordinate, in mean edge lengths.
Surface NoisyInAllDirections(Surface s, double amount)
{
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const double deviation = amount * MeanEdgeLength(mesh);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      s.Vertices(i, k) += deviation * Gaussian(3, k, i);
    }
  }
  return s;
}

} // namespace

/// Sharp edges need their points to move along the faces.
TEST(SurfaceDenoising, NoiseInAllDirectionsLeavesSharpEdges)
{
  const Surface block = LBlock(24);
  const Surface noisy = NoisyInAllDirections(block, 0.2);
  EXPECT_GT(MeanAngle(noisy, block), 20.0);
  EXPECT_LT(MeanAngle(Denoised(noisy), block), 1.2);
}

/// Steps of a part of their length leave them, unless they are turned at the end.
TEST(SurfaceDenoising, OrganicSurfacesHaveFewFlippedTriangles)
{
  const Surface surface = RoughTorus(80);
  const Surface noisy = NoisyInAllDirections(surface, 0.3);
  DenoisingSettings settings;
  settings.Type = SurfaceType::Organic;
  EXPECT_GT(NumberOfFlippedFaces(noisy, surface), 500);
  EXPECT_LT(NumberOfFlippedFaces(Denoised(noisy, settings), surface), 20);
}

/// Their displacements would be several times the noise.
TEST(SurfaceDenoising, DetailsOfFewTrianglesAreNoNoiseOfAGivenLevel)
{
  for (const Index across : { 40, 60 })
  {
    const Surface surface = RoughTorus(across);
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    DenoisingSettings settings;
    settings.NoiseLevel = 0.1 * MeanEdgeLength(mesh);
    settings.Type = SurfaceType::Organic;
    const Surface noisy = NoisyAlongNormals(surface, 0.1);
    DenoisingReport report;
    const double angle = MeanAngle(Denoised(noisy, settings, {}, &report), surface);
    EXPECT_LT(angle, 0.95 * MeanAngle(noisy, surface)) << across;
    EXPECT_EQ(report.CorrelationLength, 0.0);
  }
}

TEST(SurfaceDenoising, SurfacesWithoutNoiseStay)
{
  for (const Surface& surface :
    { LBlock(16), Icosphere(4), Torus(60, 30), Strip(20, 10), Cylinder(30, 20) })
  {
    const Surface result = Denoised(surface);
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    const double h = MeanEdgeLength(mesh);
    EXPECT_LT(LargestDistance(result, surface), 0.02 * h);
    EXPECT_LT(MeanAngle(result, surface), 0.5);
  }
}

TEST(SurfaceDenoising, NoiseOfVerticesIsEstimatedAndEdgesRaiseItLittle)
{
  for (const bool hasEdges : { false, true })
  {
    const Surface surface = hasEdges ? LBlock(20) : Icosphere(5);
    for (const double amount : { 0.1, 0.3 })
    {
      const Surface noisy = NoisyAlongNormals(surface, amount);
      const TriangleMesh clean(surface.Vertices, surface.Faces);
      const double h = MeanEdgeLength(clean);
      const TriangleMesh mesh(noisy.Vertices, noisy.Faces);
      const double estimate = EstimateVertexNoise(mesh, GatherVertices(mesh, noisy.Vertices));
      EXPECT_NEAR(estimate / (amount * h), 1.0, hasEdges ? 0.3 : 0.1);
    }
  }
}

TEST(SurfaceDenoising, DetailsOfSmoothSurfacesAreNoNoise)
{
  for (const Surface& surface : { Icosphere(4), Torus(60, 30) })
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    EXPECT_EQ(EstimateVertexNoise(mesh, GatherVertices(mesh, surface.Vertices)), 0.0);
  }
}

TEST(SurfaceDenoising, FewVerticesAmongManyTellNoNoise)
{
  for (const Index count : { 250, 300, 1000 })
  {
    DenoisingReport report;
    Denoised(TrianglesAtAnEdge(count), DenoisingSettings(), {}, &report);
    EXPECT_EQ(report.MaximumDisplacement, 0.0);
    EXPECT_EQ(report.CoarseParts, 1);
  }
}

TEST(SurfaceDenoising, NormalWithoutSupportIsReplacedAndOthersStay)
{
  FlatSurface flat;
  const Points normals = flat.Geometry.Normals;
  const Index odd = flat.Mesh.NumberOfTriangles() / 2;
  flat.Geometry.Normals.row(odd) *= -1.0;
  EXPECT_EQ(
    ReplaceUnsupportedNormals(flat.Graph, flat.Geometry, NormalFilterSettings(), SerialFor()),
    normals);
}

TEST(SurfaceDenoising, LinearFitKeepsConstantNormals)
{
  const FlatSurface flat;
  const Points& normals = flat.Geometry.Normals;
  const Points fitted =
    FitLinearNormals(flat.Graph, flat.Geometry, normals, NormalFilterSettings(), SerialFor());
  EXPECT_LT((fitted - normals).rowwise().norm().maxCoeff(), 1e-12);
}

TEST(SurfaceDenoising, LinearFitKeepsTheTurnOfNormalsAtBoundariesWhereTheMeanFlattensIt)
{
  FlatSurface flat;
  const Points& centroids = flat.Geometry.Centroids;
  for (Index f = 0; f < flat.Graph.NumberOfFaces(); ++f)
  {
    const double angle = 0.5 * centroids(f, 0);
    flat.Geometry.Normals.row(f) << std::sin(angle), 0.0, std::cos(angle);
  }
  const Points normals = flat.Geometry.Normals;
  NormalFilterSettings settings;
  settings.Width = 2.0;
  const Points linear = FitLinearNormals(flat.Graph, flat.Geometry, normals, settings, SerialFor());
  const Points mean = FilterNormals(flat.Graph, flat.Geometry, normals, settings, SerialFor());
  const double error = (linear - normals).rowwise().norm().maxCoeff();
  EXPECT_LT(error, 0.5 * (mean - normals).rowwise().norm().maxCoeff());
}

TEST(SurfaceDenoising, FoldedTrianglesOfAPlaneAreTurnedWithinThePlane)
{
  FlatSurface flat;
  const Points& normals = flat.Geometry.Normals;
  Points points = flat.Place;
  const double h = flat.Mesh.TotalEdgeLength() / flat.Mesh.NumberOfEdges();
  std::vector<char> fixed(static_cast<std::size_t>(flat.Mesh.NumberOfVertices()), 0);
  for (const Index i : flat.Mesh.BoundaryVertices())
  {
    fixed[i] = 1;
  }
  for (Index i = 0; i < flat.Mesh.NumberOfVertices(); i += 17)
  {
    points(i, 0) += fixed[i] ? 0.0 : 1.5 * h;
  }
  const Index folded = CountFlippedFaces(flat.Mesh, normals, points);
  EXPECT_GT(folded, 5);
  TurnFlippedFaces(flat.Mesh, normals, fixed, points);
  EXPECT_EQ(CountFlippedFaces(flat.Mesh, normals, points), 0);
  EXPECT_LT((points - flat.Place).col(2).cwiseAbs().maxCoeff(), 1e-12);
  for (const Index i : flat.Mesh.BoundaryVertices())
  {
    EXPECT_EQ(points.row(i), flat.Place.row(i));
  }
}

TEST(SurfaceDenoising, FlippedTrianglesNeverBecomeMore)
{
  const Surface block = LBlock(16);
  const TriangleMesh mesh(block.Vertices, block.Faces);
  FaceGeometry truth;
  truth.Measure(mesh, GatherVertices(mesh, block.Vertices) / mesh.LengthUnit(), SerialFor());
  for (const double amount : { 0.3, 0.6, 0.9 })
  {
    const Surface noisy = NoisyAlongNormals(block, amount);
    Points points = GatherVertices(mesh, noisy.Vertices) / mesh.LengthUnit();
    const Index before = CountFlippedFaces(mesh, truth.Normals, points);
    TurnFlippedFaces(mesh, truth.Normals, {}, points);
    EXPECT_LE(CountFlippedFaces(mesh, truth.Normals, points), before);
  }
}

TEST(SurfaceDenoising, FollowsRotationsTranslationsAndScalesOfTheSurface)
{
  const Surface noisy = NoisyAlongNormals(LBlock(12), 0.3);
  const Surface result = Denoised(noisy);
  const double size = noisy.Vertices.rowwise().norm().maxCoeff();
  EXPECT_LT(
    LargestDistance(Denoised(Rotated(noisy)), Rotated(result)), Rounding * MeanEdgeLength(noisy));
  EXPECT_EQ(Denoised(Scaled(noisy, 1024.0)).Vertices, Scaled(result, 1024.0).Vertices);
  EXPECT_LT(LargestDistance(Denoised(Scaled(noisy, 1e-3)), Scaled(result, 1e-3)), 1e-11 * size);
  EXPECT_LT(LargestDistance(Denoised(Scaled(noisy, 1e60)), Scaled(result, 1e60)), 1e51 * size);
  const Eigen::RowVector3d offset(30.0, -20.0, 10.0);
  EXPECT_LT(
    LargestDistance(Denoised(Moved(noisy, offset)), Moved(result, offset)), Rounding * size);
}

TEST(SurfaceDenoising, ScaledCopiesTogetherAreEachDenoisedAsAlone)
{
  const Surface noisy = NoisyAlongNormals(LBlock(12), 0.2);
  DenoisingReport one;
  const Surface alone = Denoised(noisy, DenoisingSettings(), {}, &one);
  EXPECT_GT(LargestDistance(alone, noisy), 0.05);
  for (const double scale : { 0.125, 16.0 })
  {
    DenoisingReport report;
    const Surface together =
      Denoised(Joined(noisy, Scaled(noisy, scale)), DenoisingSettings(), {}, &report);
    EXPECT_EQ(together.Vertices, Joined(alone, Scaled(alone, scale)).Vertices);
    EXPECT_EQ(report.Type, one.Type);
    EXPECT_EQ(report.CoarseParts, 0);
  }
}

namespace
{

/// A third of the cubes of a grid, whose corners are all vertices.
Surface Rubble(int size)
{
  std::set<Block> blocks;
  for (int i = 0; i < size * size * size; ++i)
  {
    if (UniformRandom(11, 0, i) < 0.35)
    {
      blocks.insert({ i % size, i / size % size, i / size / size });
    }
  }
  return BlockPart(blocks);
}

/// Circles of latitude, between which quadrilaterals are cut in two.
Surface GlobeOfQuadrilaterals(Index around, Index circles)
{
  Surface s = Cylinder(around, circles, 1.0, 1.0);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const double angle = (s.Vertices(i, 2) - s.Vertices.col(2).mean()) * 3.0;
    s.Vertices.row(i) << std::cos(angle) * s.Vertices(i, 0), std::cos(angle) * s.Vertices(i, 1),
      std::sin(angle);
  }
  return s;
}

} // namespace

TEST(SurfaceDenoising, CoarseShapesStayUnlessALevelIsGiven)
{
  Surface lens = Icosphere(0);
  lens.Vertices.col(0) *= 3.0;
  const std::vector<std::pair<const char*, Surface>> shapes = { { "icosahedron", lens },
    { "cube", Cube() }, { "frame", Frame() }, { "bracket", Bracket() },
    { "cylinder", ClosedCylinder(60, 1.0, 3.0) }, { "rubble", Rubble(7) },
    { "globe", GlobeOfQuadrilaterals(8, 6) } };
  for (const auto& [name, shape] : shapes)
  {
    SCOPED_TRACE(name);
    const Surface s = Scaled(Rotated(shape, 0.3), 1e3);
    DenoisingReport report;
    EXPECT_EQ(Denoised(s, DenoisingSettings(), {}, &report).Vertices, s.Vertices);
    EXPECT_EQ(report.CoarseParts, report.Parts);
    EXPECT_EQ(report.NoiseLevel, 0.0);
    DenoisingSettings given;
    given.NoiseLevel = 0.1 * MeanEdgeLength(s);
    EXPECT_GT(LargestDistance(Denoised(s, given, {}, &report), s), 0.0);
    EXPECT_EQ(report.CoarseParts, 0);
  }
}

TEST(SurfaceDenoising, ACoarsePartBesideANoisyOneStays)
{
  const Surface noisy = NoisyAlongNormals(LBlock(12), 0.2);
  const Surface coarse = Moved(Bracket(), { 30.0, 0.0, 0.0 });
  DenoisingReport report;
  const Surface together = Denoised(Joined(noisy, coarse), DenoisingSettings(), {}, &report);
  EXPECT_EQ(together.Vertices, Joined(Denoised(noisy), coarse).Vertices);
  EXPECT_EQ(report.Parts, 2);
  EXPECT_EQ(report.CoarseParts, 1);
}

TEST(SurfaceDenoising, ChangesOfTheVolumeOfAPartAreReported)
{
  const Surface noisy = NoisyAlongNormals(LBlock(12), 0.2);
  DenoisingReport report;
  Denoised(noisy, DenoisingSettings(), {}, &report);
  EXPECT_LT(std::abs(report.VolumeChange), 0.01);
  const Surface rod = Moved(ClosedCylinder(8, 0.3, 1.0), { 30.0, 0.0, 0.0 });
  DenoisingSettings given;
  given.NoiseLevel = 0.3;
  const Surface all = Joined(Cube(9.0), rod); // both are coarse
  const Surface result = Denoised(all, given, {}, &report);
  const Index corners = 8; // of the cube
  const auto change = [&](Index first, Index count, const Surface& part)
  {
    const Surface before{ all.Vertices.middleRows(first, count), part.Faces };
    const Surface after{ result.Vertices.middleRows(first, count), part.Faces };
    return Volume(after) / Volume(before) - 1.0;
  };
  const double ofCube = change(0, corners, Cube());
  const double ofRod = change(corners, rod.NumberOfVertices(), rod);
  EXPECT_NEAR(report.VolumeChange, std::min(ofCube, ofRod), 1e-9);
  EXPECT_LT(report.VolumeChange, -0.02);
}

TEST(SurfaceDenoising, ComponentsOfDifferentTypesKeepTheirs)
{
  const Surface block = NoisyAlongNormals(LBlock(12), 0.2);
  const Surface rough = NoisyAlongNormals(RoughTorus(120), 0.3);
  DenoisingReport report;
  const Surface together = Denoised(Joined(block, rough), DenoisingSettings(), {}, &report);
  const Surface alone = Joined(Denoised(block), Denoised(rough));
  EXPECT_LT(LargestDistance(together, alone), 1e-12);
  EXPECT_EQ(report.Type, SurfaceType::Automatic);
}

// Also of a surface without noise, of which nothing else moves.
TEST(SurfaceDenoising, SpikesAreMovedBetweenTheirNeighboursAndCounted)
{
  for (const Surface& clean : { LBlock(16), RoughTorus(60) })
  {
    for (const double sigma : { 0.0, 0.2 })
    {
      for (const double height : { 10.0, 1e4 }) // in mean edge lengths
      {
        const Surface noisy = sigma > 0.0 ? NoisyAlongNormals(clean, sigma) : clean;
        const TriangleMesh mesh(clean.Vertices, clean.Faces);
        const double h = mesh.MeanEdgeLength() * mesh.LengthUnit();
        Surface spiky = noisy;
        Index spikes = 0;
        for (Index i = 7; i < spiky.NumberOfVertices(); i += 101)
        {
          const Eigen::RowVector3d way(UniformRandom(1, 0, i) - 0.5, UniformRandom(1, 1, i) - 0.5,
            UniformRandom(1, 2, i) - 0.5);
          spiky.Vertices.row(i) += height * h * way.normalized();
          ++spikes;
        }
        DenoisingReport report;
        const Surface result = Denoised(spiky, DenoisingSettings(), {}, &report);
        const Surface without = Denoised(noisy);
        EXPECT_EQ(report.Spikes, spikes) << sigma << " " << height;
        EXPECT_EQ(report.FarVertices, 0);
        EXPECT_LT(LargestDistance(result, without), 0.8 * h); // of corners, from the mean around
      }
    }
  }
}

namespace
{

/// The same surface with triangles turned at random.
Surface TurnedAtRandom(Surface s)
{
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    if (UniformRandom(4, 0, t) < 0.5)
    {
      std::swap(s.Faces(t, 0), s.Faces(t, 1));
    }
  }
  return s;
}

} // namespace

TEST(SurfaceDenoising, TrianglesMayBeTurned)
{
  const Surface block = LBlock(16);
  const Surface noisy = NoisyAlongNormals(block, 0.3);
  const Surface turned = TurnedAtRandom(noisy);
  EXPECT_LT(std::abs(Volume(turned)), 0.5 * Volume(noisy));
  EXPECT_LT(LargestDistance(Denoised(turned), Denoised(noisy)), Rounding * MeanEdgeLength(noisy));
}

TEST(SurfaceDenoising, OrientationFollowsTheLargerPartOfTheAreaAcrossManifoldEdges)
{
  const Surface block = LBlock(6);
  Surface few = block;
  for (const Index t : { 3, 50, 51, 120 })
  {
    std::swap(few.Faces(t, 1), few.Faces(t, 2));
  }
  OrientTriangles(few.Vertices, few.Faces);
  EXPECT_EQ(few.Faces, block.Faces);
  Surface most = Flipped(few);
  std::swap(most.Faces(7, 1), most.Faces(7, 2));
  OrientTriangles(most.Vertices, most.Faces);
  EXPECT_EQ(most.Faces, Flipped(block).Faces);
  const Surface fins = ThreeFins(4); // an edge of three triangles joins no orientations
  Surface kept = fins;
  OrientTriangles(kept.Vertices, kept.Faces);
  EXPECT_EQ(kept.Faces, fins.Faces);
  Surface band = Moebius(20, 4);
  OrientTriangles(band.Vertices, band.Faces); // it has one side only, and the work ends
  EXPECT_EQ(band.NumberOfTriangles(), Moebius(20, 4).NumberOfTriangles());
}

/// Two squares and between them a twisted seam of two triangles without area, as those of VTK's
/// parametric torus: through it, one of the squares would be turned.
TEST(SurfaceDenoising, TrianglesWithoutOrientationTurnNoOthers)
{
  Surface seam = MakeSurface({ { 0, 1, 0 }, { 1, 1, 0 }, { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 0 },
                               { 1, 0, 0 }, { 0, -1, 0 }, { 1, -1, 0 } },
    { { 0, 2, 3 }, { 0, 3, 1 }, { 3, 2, 5 }, { 3, 5, 4 }, { 4, 6, 7 }, { 4, 7, 5 } });
  const Triangles drawn = seam.Faces;
  OrientTriangles(seam.Vertices, seam.Faces);
  EXPECT_EQ(seam.Faces.topRows(2), drawn.topRows(2));
  EXPECT_EQ(seam.Faces.bottomRows(2), drawn.bottomRows(2));
  seam.Faces.col(1).swap(seam.Faces.col(2));
  const Triangles turned = seam.Faces;
  OrientTriangles(seam.Vertices, seam.Faces);
  EXPECT_EQ(seam.Faces.topRows(2), turned.topRows(2));
  EXPECT_EQ(seam.Faces.bottomRows(2), turned.bottomRows(2));
}

namespace
{

/// A disc of one ring of triangles around its middle, with waves.
Surface Fan(Index triangles)
{
  Surface s{ Points(triangles + 1, 3), Triangles(triangles, 3) };
  for (Index i = 0; i < triangles; ++i)
  {
    const double angle = 2.0 * Pi * i / triangles;
    s.Vertices.row(i) << std::cos(angle), std::sin(angle), 0.01 * std::sin(40.0 * i);
    s.Faces.row(i) << i, (i + 1) % triangles, triangles;
  }
  s.Vertices.row(triangles).setZero();
  return s;
}

} // namespace

TEST(SurfaceDenoising, TrianglesAroundAVertexOfAnyValenceHaveFewNeighbours)
{
  for (const Index count : { 8, 32, 33, 1000, 20000 })
  {
    const Surface fan = Fan(count);
    const TriangleMesh mesh(fan.Vertices, fan.Faces);
    const FaceGraph graph(mesh);
    for (Index f = 0; f < count; ++f)
    {
      const auto begin = graph.Ring.Entries.begin();
      const auto size = graph.Ring.Begin[f + 1] - graph.Ring.Begin[f];
      ASSERT_TRUE(size == count - 1 || (count > LargestFan && size <= 40)) << size;
      ASSERT_EQ(graph.Across.Begin[f + 1] - graph.Across.Begin[f], 2);
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        ASSERT_TRUE(
          std::binary_search(begin + graph.Ring.Begin[g], begin + graph.Ring.Begin[g + 1], f));
      }
    }
  }
}

/// 10,000 triangles take less than a second. With all pairs of triangles as neighbours, 2,000 took
/// 40 seconds, most of them without a report.
TEST(SurfaceDenoising, LargeFansEndAndReportProgress)
{
  const Surface fan = Fan(10000);
  const TriangleMesh mesh(fan.Vertices, fan.Faces);
  DenoisingSettings settings;
  for (const SurfaceType type : { SurfaceType::CAD, SurfaceType::Organic })
  {
    settings.Type = type;
    settings.NoiseLevel = 0.01;
    std::clock_t last = std::clock();
    std::clock_t longest = 0;
    const ProgressMonitor::Callback measure = [&](double)
    {
      const std::clock_t now = std::clock();
      longest = std::max(longest, now - last);
      last = now;
      return true;
    };
    const Points moved = DenoiseSurface(mesh, GatherVertices(mesh, fan.Vertices), {}, settings,
      nullptr, SerialFor(), ProgressMonitor(measure));
    EXPECT_TRUE(moved.allFinite());
    EXPECT_LT(static_cast<double>(longest) / CLOCKS_PER_SEC, 1.0); // 0.1
  }
}

/// Of processor time: on one thread, under other load.
TEST(SurfaceDenoising, AbortEndsTheWorkOnALargeFanSoon)
{
  const Surface fan = Fan(4000);
  const TriangleMesh mesh(fan.Vertices, fan.Faces);
  DenoisingSettings settings;
  settings.NoiseLevel = 0.01;
  // The processor time of the longest run to its end
  settings.Type = SurfaceType::CAD;
  const std::clock_t start = std::clock();
  DenoiseSurface(mesh, GatherVertices(mesh, fan.Vertices), {}, settings, nullptr, SerialFor());
  const auto whole = static_cast<double>(std::clock() - start);
  for (const SurfaceType type : { SurfaceType::Automatic, SurfaceType::CAD, SurfaceType::Organic })
  {
    settings.Type = type;
    for (const double from : { 0.0, 0.04, 0.08, 0.2, 0.4, 0.7, 0.9, 0.95, 1.0 })
    {
      // the user asks for it at once after a report, so that the next one obeys or the work ends
      bool isAsked = false;
      std::clock_t asked = 0;
      const ProgressMonitor::Callback stop = [&](double fraction)
      {
        if (isAsked)
        {
          return false;
        }
        isAsked = fraction >= from;
        asked = std::clock();
        return true;
      };
      bool isAborted = false;
      try
      {
        DenoiseSurface(mesh, GatherVertices(mesh, fan.Vertices), {}, settings, nullptr, SerialFor(),
          ProgressMonitor(stop));
      }
      catch (const Aborted&)
      {
        isAborted = true;
      }
      EXPECT_TRUE(isAborted || from >= 0.9) << from;
      EXPECT_TRUE(isAsked);
      EXPECT_LT(static_cast<double>(std::clock() - asked), 0.05 * whole) << from;
    }
  }
}

TEST(SurfaceDenoising, FixedPointsDoNotEndTheWorkOnOthers)
{
  const Surface sphere = Icosphere(5);
  const Surface noisy = NoisyAlongNormals(sphere, 0.3);
  Surface noisyCap = sphere;
  std::vector<char> fixed(static_cast<std::size_t>(sphere.NumberOfVertices()), 1);
  double free = 0.0;
  for (Index i = 0; i < sphere.NumberOfVertices(); ++i)
  {
    if (sphere.Vertices(i, 2) > 0.9)
    {
      noisyCap.Vertices.row(i) = noisy.Vertices.row(i);
      fixed[i] = 0;
      free += 1.0;
    }
  }
  DenoisingSettings settings;
  settings.NoiseLevel = 0.3 * MeanEdgeLength(sphere);
  settings.Type = SurfaceType::Organic;
  const Surface result = Denoised(noisyCap, settings, fixed);
  const double meanSquare = (result.Vertices - sphere.Vertices).squaredNorm() / free;
  EXPECT_LT(std::sqrt(meanSquare), 0.065 * MeanEdgeLength(sphere)); // with noise everywhere 0.057
}

TEST(SurfaceDenoising, BoundariesDoNotShrink)
{
  const Surface flat = Strip(30, 20, 3.0, 2.0);
  const Surface noisy = NoisyAlongNormals(flat, 0.3);
  const Surface result = Denoised(noisy);
  EXPECT_LT(MeanAngle(result, flat), 1.0);
  const TriangleMesh mesh(flat.Vertices, flat.Faces);
  const double h = MeanEdgeLength(mesh);
  for (Index i = 0; i < flat.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d d = result.Vertices.row(i) - flat.Vertices.row(i);
    EXPECT_LT(d.head<2>().norm(), 0.5 * h);
  }
}

TEST(SurfaceDenoising, LargerNoiseLevelsRemoveMoreAndTheTypeCanBeGiven)
{
  const Surface sphere = Icosphere(4);
  const Surface noisy = NoisyAlongNormals(sphere, 0.2);
  DenoisingReport report;
  DenoisingSettings settings;
  const Surface automatic = Denoised(noisy, settings, {}, &report);
  const TriangleMesh mesh(noisy.Vertices, noisy.Faces);
  settings.NoiseLevel = 0.1 * report.NoiseLevel * mesh.LengthUnit();
  EXPECT_GT(MeanAngle(Denoised(noisy, settings), sphere), 2.0 * MeanAngle(automatic, sphere));
  settings.NoiseLevel = 0.0;
  settings.Type = SurfaceType::CAD;
  Denoised(noisy, settings, {}, &report);
  EXPECT_EQ(report.Type, SurfaceType::CAD);
}

namespace
{

/// Two planes that differ by an angle, in degrees.
Surface Roof(Index columns, double angle)
{
  Surface roof = Strip(columns, columns, 2.0, 2.0);
  for (Index i = 0; i < roof.NumberOfVertices(); ++i)
  {
    roof.Vertices(i, 2) =
      -std::abs(roof.Vertices(i, 0) - 1.0) * std::tan(angle * std::acos(-1.0) / 360.0);
  }
  return roof;
}

/// Noise along the normals, which its creases do not have.
struct NoisyBetweenCreases
{
  explicit NoisyBetweenCreases(const Surface& surface, double amount)
    : Noisy(NoisyAlongNormals(surface, amount))
  {
    const TriangleMesh mesh(surface.Vertices, surface.Faces);
    ForEachInnerEdge(mesh,
      [&](Index low, Index high, Index first, Index second)
      {
        const auto at = [&](Index i) -> Eigen::RowVector3d
        { return surface.Vertices.row(mesh.InputVertex()[i]); };
        const Eigen::RowVector3d n = (at(high) - at(low)).cross(at(first) - at(low)).normalized();
        if (std::abs(n.dot((at(second) - at(low)).normalized())) > 0.02)
        {
          const std::pair<Index, Index> edge(mesh.InputVertex()[low], mesh.InputVertex()[high]);
          this->Creases.push_back(edge);
          for (const Index i : { edge.first, edge.second })
          {
            this->Noisy.Vertices.row(i) = surface.Vertices.row(i);
          }
        }
      });
  }

  Surface Noisy;
  VertexPairs Creases;
};

} // namespace

TEST(SurfaceDenoising, CreasesStayAndPartTheirSides)
{
  const Surface roof = Roof(40, 6.0);
  const NoisyBetweenCreases given(roof, 0.2);
  DenoisingSettings settings;
  settings.NoiseLevel = 0.2 * MeanEdgeLength(roof);
  const double without = MeanAngle(Denoised(given.Noisy, settings), roof);
  settings.Creases = given.Creases;
  const Surface result = Denoised(given.Noisy, settings);
  for (const auto& [i, j] : given.Creases)
  {
    EXPECT_EQ(result.Vertices.row(i), roof.Vertices.row(i));
    EXPECT_EQ(result.Vertices.row(j), roof.Vertices.row(j));
  }
  EXPECT_LT(MeanAngle(result, roof), 0.75 * without);
}

TEST(SurfaceDenoising, EdgesFromAnAngleOnStay)
{
  const Surface block = LBlock(24);
  const NoisyBetweenCreases given(block, 0.03);
  DenoisingSettings settings;
  settings.CreaseAngle = 60.0;
  const Surface result = Denoised(given.Noisy, settings);
  double largest = 0.0;
  for (const auto& [i, j] : given.Creases)
  {
    largest = std::max(largest, (result.Vertices.row(i) - block.Vertices.row(i)).norm());
  }
  EXPECT_EQ(largest, 0.0);
  EXPECT_LT(MeanAngle(result, block), 0.3 * MeanAngle(given.Noisy, block));
  settings.CreaseAngle = 1e-6; // every edge of a noisy surface
  const Surface noisy = NoisyAlongNormals(block, 0.3);
  EXPECT_EQ(LargestDistance(Denoised(noisy, settings), noisy), 0.0);
}

TEST(SurfaceDenoising, NoPointMovesFartherThanTheLimit)
{
  Surface noisy = NoisyAlongNormals(LBlock(24), 0.3);
  noisy.Vertices.row(100) *= 3.0; // a spike
  DenoisingSettings settings;
  settings.DisplacementLimit = 0.2 * MeanEdgeLength(noisy);
  DenoisingReport report;
  const Surface limited = Denoised(noisy, settings, {}, &report);
  EXPECT_NEAR(LargestDistance(limited, noisy), settings.DisplacementLimit, 1e-9);
  EXPECT_GT(report.LimitedVertices, 100);
  const Surface result = Denoised(noisy);
  for (Index i = 0; i < noisy.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d step = result.Vertices.row(i) - noisy.Vertices.row(i);
    const double shorter = std::min(1.0, settings.DisplacementLimit / step.norm());
    EXPECT_NEAR(
      (limited.Vertices.row(i) - noisy.Vertices.row(i) - shorter * step).norm(), 0.0, 1e-9);
  }
}
