// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs on data that are given on cells.

#include "CellRun.h"
#include "Meshes.h"

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

using namespace Testing;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

HeatSettings SteadyState(double fidelity)
{
  HeatSettings settings;
  settings.Mode = HeatMode::SteadyState;
  settings.FidelityWeight = fidelity;
  settings.Solver = SolverMethod::Direct;
  return settings;
}

/// The cells within a distance of a point.
std::vector<char> CellsNear(const CellInput& input, const Eigen::RowVector3d& centre, double radius)
{
  std::vector<char> found;
  const Points centres = input.Centres();
  for (const auto& x : centres.rowwise())
  {
    found.push_back((x - centre).norm() < radius);
  }
  return found;
}

void SetMissing(CellInput& input, const std::vector<char>& cells)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (cells[c] != 0)
    {
      input.Data.Data.Values(static_cast<Eigen::Index>(c), 0) = NaN;
    }
  }
}

/// A grid on the torus whose quads are cut along the diagonal that `cut(i, j)` selects. With
/// hexagons, two quads are one cell.
CellInput TorusOfPolygons(Index around, Index across, bool (*cut)(Index, Index), Index quadsPerCell)
{
  Testing::Surface torus = Torus(around, across);
  for (Index q = 0; q < around * across; ++q)
  {
    // Torus() cuts a quad as { a, b, d }, { a, d, c } or as { a, b, c }, { b, d, c }.
    const bool first = (q % around + q / around) % 2 == 0;
    auto upper = torus.Faces.row(2 * q);
    auto lower = torus.Faces.row(2 * q + 1);
    const Index a = upper[0], b = upper[1], c = first ? lower[2] : upper[2],
                d = first ? upper[2] : lower[1];
    if (cut(q % around, q / around))
    {
      upper << a, b, d;
      lower << a, d, c;
    }
    else
    {
      upper << a, b, c;
      lower << b, d, c;
    }
  }
  std::vector<Index> cells(static_cast<std::size_t>(torus.NumberOfTriangles()));
  for (std::size_t t = 0; t < cells.size(); ++t)
  {
    cells[t] = static_cast<Index>(t) / (2 * quadsPerCell);
  }
  CellInput input(torus, cells);
  const auto angles = [around, across, quadsPerCell](Index c)
  {
    const Index quad = c * quadsPerCell;
    return std::array<double, 2>{ 2.0 * Pi * (quad % around + 0.5 * quadsPerCell) / around,
      2.0 * Pi * (quad / around + 0.5) / across };
  };
  input.SetData([&](Index c, const Eigen::RowVector3d&)
    { return std::sin(2.0 * angles(c)[0]) + std::cos(angles(c)[1]) * std::cos(angles(c)[0]); });
  return input;
}

} // namespace

TEST(CellData, AModelThatChangesNothingReturnsTheirBits)
{
  CellInput input(Torus(32, 20));
  input.Data.Data.Values(3, 0) = -0.0;
  HeatSettings none;
  none.NumberOfTimeSteps = 0;
  const Values same = CellResultOf(input, none);
  EXPECT_EQ(same, input.Data.Data.Values);
  EXPECT_TRUE(std::signbit(same(3, 0)));
}

/// Cosines on a regular strip, in every cell.
TEST(CellData, AnEigenfunctionDecaysAtItsEigenvalueWithSecondOrder)
{
  constexpr double time = 0.05;
  for (const bool quads : { false, true })
  {
    std::vector<double> errors;
    for (const Index n : { 8, 16, 32, 64 })
    {
      const Testing::Surface strip = Strip(n, n / 2, 1.0, 0.5);
      CellInput input(strip, quads ? CellsOfQuads(strip) : std::vector<Index>());
      input.SetData([](Index, const Eigen::RowVector3d& x) { return std::cos(Pi * x[0]); });
      HeatSettings settings;
      settings.Units = UnitsMode::Absolute;
      settings.NumberOfTimeSteps = n;
      settings.TimeStep = time / n;
      const Values result = CellResultOf(input, settings);
      errors.push_back(
        (result - std::exp(-Pi * Pi * time) * input.Data.Data.Values).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(errors.back(), 5e-4);
    for (std::size_t e = 1; e < errors.size(); ++e)
    {
      EXPECT_GT(ObservedOrder(errors[e - 1], errors[e]), 1.9) << e;
    }
  }
}

/// On the irregular triangles of a sphere the transfer to the vertices is of first order at single
/// vertices, and of second order on the average.
TEST(CellData, AnEigenfunctionOfTheSphereDecaysAtItsEigenvalueWithSecondOrderOnTheAverage)
{
  // u = z has the eigenvalue 2 on the unit sphere.
  constexpr double time = 0.2;
  std::vector<double> errors, deviations;
  for (const int level : { 1, 2, 3, 4 })
  {
    CellInput input(Icosphere(level));
    input.SetData([](Index, const Eigen::RowVector3d& x) { return x[2] / x.norm(); });
    HeatSettings settings;
    settings.Units = UnitsMode::Absolute;
    settings.NumberOfTimeSteps = 4 << level;
    settings.TimeStep = time / settings.NumberOfTimeSteps;
    SurfaceDiffusion::Run run(SerialFor());
    const Values result = CellResultOf(run, input, settings);
    const Vector& areas = run.GetBlock(0).Cells->Transfer.CellAreas();
    const Values difference = result - std::exp(-2.0 * time) * input.Data.Data.Values;
    const double size = areas.dot(input.Data.Data.Values.col(0).cwiseAbs2());
    errors.push_back(
      std::abs(areas.dot(difference.col(0).cwiseProduct(input.Data.Data.Values.col(0)))) / size);
    deviations.push_back(Deviation(areas, difference));
  }
  EXPECT_LT(errors.back(), 1e-3);
  for (std::size_t e = 1; e < errors.size(); ++e)
  {
    EXPECT_GT(ObservedOrder(errors[e - 1], errors[e]), 1.9) << e;
  }
  EXPECT_GT(ObservedOrder(deviations.front(), deviations.back(), 8.0), 1.3)
    << deviations[0] << ' ' << deviations[1] << ' ' << deviations[2] << ' ' << deviations[3];
}

TEST(CellData, AreNotSmoothedByTheRoundTrip)
{
  CellInput input(Icosphere(4));
  input.SetData([](Index c, const Eigen::RowVector3d&) { return UniformRandom(5, 0, c); });
  HeatSettings settings;
  settings.NumberOfTimeSteps = 1;
  settings.TimeStep = 1e-7;
  SurfaceDiffusion::Run run(SerialFor());
  const Values kept = CellResultOf(run, input, settings);
  EXPECT_LT((kept - input.Data.Data.Values).cwiseAbs().maxCoeff(), 1e-5);
  // Strong smoothing removes the detail that the vertices do not resolve, too.
  const Vector areas = run.GetBlock(0).Cells->Transfer.CellAreas();
  const double noise = Deviation(areas, input.Data.Data.Values);
  const HeatSettings strong = SteadyState(0.0);
  EXPECT_LT(Deviation(areas, CellResultOf(input, strong)), 1e-9 * noise);
  EXPECT_LT(Deviation(areas, CellResultOf(input, strong, false)), 1e-9 * noise);
}

TEST(CellData, OfPolygonsDependOnTheDiagonalsBySecondOrder)
{
  const auto rising = [](Index, Index) { return true; };
  const auto falling = [](Index, Index) { return false; };
  const auto mixed = [](Index i, Index j) { return (i * 7 + j * 5) % 3 == 0; };
  HeatSettings settings;
  settings.Units = UnitsMode::Absolute;
  settings.NumberOfTimeSteps = 20;
  settings.TimeStep = 0.02;
  for (const Index quadsPerCell : { 1, 2 })
  {
    for (const auto other : { +falling, +mixed })
    {
      std::vector<double> differences;
      for (const Index n : { 16, 32, 64 })
      {
        const CellInput first = TorusOfPolygons(2 * n, n, rising, quadsPerCell);
        const CellInput second = TorusOfPolygons(2 * n, n, other, quadsPerCell);
        ASSERT_EQ(first.Data.Data.Values, second.Data.Data.Values);
        const Values result = CellResultOf(first, settings);
        EXPECT_GT((result - first.Data.Data.Values).cwiseAbs().maxCoeff(), 0.1);
        differences.push_back((result - CellResultOf(second, settings)).cwiseAbs().maxCoeff());
      }
      for (std::size_t e = 1; e < differences.size(); ++e)
      {
        EXPECT_GT(ObservedOrder(differences[e - 1], differences[e]), 1.7)
          << quadsPerCell << ' ' << differences[e - 1] << ' ' << differences[e];
      }
    }
  }
}

TEST(CellData, AreFilledInWhereTheyAreMissing)
{
  // The harmonic function of x is x.
  for (const Index n : { 16, 32 })
  {
    CellInput input(Strip(n, n));
    input.SetData([](Index, const Eigen::RowVector3d& x) { return x[0]; });
    const Values exact = input.Data.Data.Values;
    SetMissing(input, CellsNear(input, { 0.5, 0.5, 0.0 }, 0.25));
    HeatSettings settings = SteadyState(0.0);
    settings.HoldKnownValues = true;
    EXPECT_LT((CellResultOf(input, settings) - exact).cwiseAbs().maxCoeff(), 1.0 / n);
  }
}

TEST(CellData, ExcludedCellsAreAsIfTheyWereNotThere)
{
  CellInput input(Torus(16, 10));
  const std::vector<char> excluded = CellsNear(input, { 3.0, 0.0, 0.0 }, 0.9);
  const auto exclude = [&](BlockInput block)
  {
    block.ReadSurface = [&]
    {
      SurfaceArrays arrays{ input.Vertices, input.Faces, {} };
      arrays.ExcludedTriangles = excluded;
      return arrays;
    };
    return block;
  };
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { exclude(input.Block()) }, HeatSettings());
  const Run::Block& block = run.GetBlock(0);
  const Values result =
    MakeCellResult(*block.Cells, block.Path->State(), input.Data.Data.Values, true);
  EXPECT_TRUE(run.FindWarnings(Alone).empty());

  CellInput without(Torus(16, 10));
  std::vector<Index> rows;
  for (std::size_t t = 0; t < excluded.size(); ++t)
  {
    if (excluded[t] == 0)
    {
      rows.push_back(static_cast<Index>(t));
    }
    else
    {
      EXPECT_EQ(result(static_cast<Index>(t), 0), input.Data.Data.Values(static_cast<Index>(t), 0));
    }
  }
  ASSERT_LT(rows.size() + 5, excluded.size());
  without.Faces.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    without.Faces.row(static_cast<Eigen::Index>(k)) = input.Faces.row(rows[k]);
  }
  without.Data.Cells = rows;
  EXPECT_EQ(CellResultOf(without, HeatSettings()), result);
}

TEST(CellData, OfFactorZeroHaveNoEffectOnTheSteadyState)
{
  CellInput doubted(Torus(16, 10));
  const std::vector<char> near = CellsNear(doubted, { 3.0, 0.0, 0.0 }, 0.7);
  CellInput missing = doubted;
  SetMissing(missing, near);
  doubted.Data.FidelityFactors.OnCells = true;
  for (const char isNear : near)
  {
    doubted.Data.FidelityFactors.Values.push_back(isNear != 0 ? 0.0 : 1.0);
  }
  SurfaceDiffusion::Run first(SerialFor()), second(SerialFor());
  HeatSettings settings = SteadyState(0.1);
  settings.Units = UnitsMode::Absolute;
  const Values u = StateOf(first, { doubted.Block() }, settings);
  const Values v = StateOf(second, { missing.Block() }, settings);
  EXPECT_LT((u - v).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((u.array() - u.mean()).abs().maxCoeff(), 0.05);
}

/// The functional of CellFields.h, whose minimiser has a small gradient.
TEST(CellData, TheFidelityTermIsThatOfTheCells)
{
  CellInput input(Strip(12, 8));
  input.Data.FidelityFactors.OnCells = true;
  for (Index c = 0; c < input.Data.NumberOfCells; ++c)
  {
    input.Data.FidelityFactors.Values.push_back(0.5 + UniformRandom(2, 0, c));
  }
  SetMissing(input, CellsNear(input, { 0.5, 0.5, 0.0 }, 0.2));
  HeatSettings settings = SteadyState(7.0);
  settings.Units = UnitsMode::Absolute;
  SurfaceDiffusion::Run run(SerialFor());
  const Values u = StateOf(run, { input.Block() }, settings);
  const TriangleMesh& mesh = run.GetBlock(0).Surface->Mesh();
  const auto energy = [&](const Values& values)
  {
    double sum = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
      const double area = mesh.Shapes()[static_cast<std::size_t>(t)].Area();
      Eigen::RowVector3d x[3];
      double at[3];
      for (int a = 0; a < 3; ++a)
      {
        const Index v = mesh.TriangleVertices()(t, a);
        x[a] = input.Vertices.row(mesh.InputVertex()[static_cast<std::size_t>(v)]);
        at[a] = values(v, 0);
        if (!std::isnan(input.Data.Data.Values(row, 0)))
        {
          sum += 3.5 * input.Data.FidelityFactors.Values[static_cast<std::size_t>(row)] * area /
            3.0 * std::pow(input.Data.Data.Values(row, 0) - at[a], 2);
        }
      }
      const Eigen::RowVector3d edge1 = x[1] - x[0], edge2 = x[2] - x[0];
      const double ee = edge1.squaredNorm(), ff = edge2.squaredNorm(), ef = edge1.dot(edge2);
      const double p = at[1] - at[0], q = at[2] - at[0];
      sum += 0.5 * area * (p * p * ff - 2.0 * p * q * ef + q * q * ee) / (ee * ff - ef * ef);
    }
    return sum;
  };
  ASSERT_EQ(mesh.LengthUnit(), 1.0);
  const double least = energy(u);
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (const double step : { -1e-3, 1e-3 })
    {
      Values moved = u;
      moved(v, 0) += step;
      EXPECT_GT(energy(moved), least);
    }
  }
}

TEST(CellData, MarksOfPointsMarkTheirCells)
{
  CellInput onPoints(Torus(16, 10));
  onPoints.Data.Mask.Values.assign(static_cast<std::size_t>(onPoints.Vertices.rows()), 0);
  onPoints.Data.Mask.Values[17] = 1;
  CellInput onCells = onPoints;
  onCells.Data.Mask.OnCells = true;
  onCells.Data.Mask.Values.clear();
  for (const auto& face : onCells.Faces.rowwise())
  {
    onCells.Data.Mask.Values.push_back((face.array() == 17).any());
  }
  EXPECT_EQ(CellResultOf(onPoints, HeatSettings()), CellResultOf(onCells, HeatSettings()));
}

TEST(CellData, MarksOfCellsMarkTheirPoints)
{
  const CellInput cells(Torus(16, 10));
  RunInput expected(Torus(16, 10));
  RunInput given = expected;
  const std::vector<char> near = CellsNear(cells, { 3.0, 0.0, 0.0 }, 0.7);
  expected.Data.Mask.Values.assign(static_cast<std::size_t>(expected.Vertices.rows()), 0);
  for (std::size_t t = 0; t < near.size(); ++t)
  {
    for (int a = 0; a < 3 && near[t] != 0; ++a)
    {
      expected.Data.Mask.Values[static_cast<std::size_t>(cells.Faces(static_cast<Index>(t), a))] =
        1;
    }
  }
  given.Data.Cells = cells.Data.Cells;
  given.Data.NumberOfCells = cells.Data.NumberOfCells;
  given.Data.Mask.Values = near;
  given.Data.Mask.OnCells = true;
  SurfaceDiffusion::Run first(SerialFor()), second(SerialFor());
  EXPECT_EQ(StateOf(first, { given.Block() }, HeatSettings()),
    StateOf(second, { expected.Block() }, HeatSettings()));
}

TEST(CellData, UnitVectorsStayUnitAndConstantOnesStay)
{
  for (const bool lines : { false, true })
  {
    CellInput input(Torus(16, 10));
    input.Data.Data.Values.resize(input.Data.NumberOfCells, 3);
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      const double sign = lines && c % 3 == 0 ? -1.0 : 1.0;
      const double angle = 0.4 * (UniformRandom(4, 0, c) - 0.5);
      input.Data.Data.Values.row(c) << sign * std::cos(angle), sign * std::sin(angle), 0.0;
    }
    HarmonicMapSettings settings;
    settings.LineField = lines;
    const Values result = CellResultOf(input, settings, false);
    const Values detailed = CellResultOf(input, settings, true);
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      EXPECT_NEAR(detailed.row(c).norm(), 1.0, 1e-14);
      EXPECT_GT(detailed.row(c).dot(input.Data.Data.Values.row(c)), 0.9);
      EXPECT_NEAR(result.row(c).norm(), 1.0, 1e-14);
      EXPECT_GT(std::abs(result(c, 0)), 0.99);
    }
    settings.NumberOfTimeSteps = 0;
    EXPECT_LT(
      (CellResultOf(input, settings) - input.Data.Data.Values).cwiseAbs().maxCoeff(), 1e-15);
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      input.Data.Data.Values.row(c) << (lines && c % 3 == 0 ? -2.0 : 2.0), 0.0, 0.0;
    }
    EXPECT_LT((CellResultOf(input, HarmonicMapSettings(settings)) - 0.5 * input.Data.Data.Values)
                .cwiseAbs()
                .maxCoeff(),
      1e-14);
  }
}

TEST(CellData, SegmentsHaveTheLabelsOfTwoValuesAndOfSeeds)
{
  CellInput input(Icosphere(4));
  input.SetData([](Index, const Eigen::RowVector3d& x) { return x[2] > 0.3 ? 5.0 : 1.0; });
  input.Data.Seeds.Values.assign(static_cast<std::size_t>(input.Data.NumberOfCells), 0);
  input.Data.Seeds.Values[7] = 2;
  input.Data.Seeds.OnCells = true;
  SurfaceDiffusion::Run run(SerialFor());
  const Values u = StateOf(run, { input.Block() }, SegmentationSettings());
  const std::vector<Index> labels = MakeCellLabels(*run.GetBlock(0).Cells, u);
  EXPECT_EQ(labels[7], 2);
  const Points centres = input.Centres();
  for (Index c = 0; c < input.Data.NumberOfCells; ++c)
  {
    if (std::abs(centres(c, 2) - 0.3) > 0.1 && (centres.row(c) - centres.row(7)).norm() > 0.3)
    {
      EXPECT_EQ(labels[static_cast<std::size_t>(c)], centres(c, 2) > 0.3 ? 2 : 1) << c;
    }
  }
  input.Data.Seeds.Values[9] = 3;
  SurfaceDiffusion::Run another(SerialFor());
  EXPECT_THROW(StateOf(another, { input.Block() }, SegmentationSettings()), std::runtime_error);
}

TEST(CellData, NoiseLevelIsThatOfTheCells)
{
  CellInput input(Icosphere(4));
  input.SetData([](Index c, const Eigen::RowVector3d& x)
    { return (x[2] > 0.3 ? 1.0 : 0.0) + 0.6 * (UniformRandom(5, 0, c) - 0.5); });
  TotalVariationSettings settings;
  settings.Mode = TotalVariationMode::SteadyState;
  settings.AutomaticFidelity = true;
  settings.NoiseLevel = 0.6 / std::sqrt(12.0);
  SurfaceDiffusion::Run run(SerialFor());
  const auto weight = [&](double level)
  {
    settings.NoiseLevel = level;
    StateOf(run, { input.Block() }, settings);
    EXPECT_TRUE(run.FindWarnings(Alone).empty());
    return FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
  };
  const double level = settings.NoiseLevel;
  const double given = weight(level);
  EXPECT_NEAR(weight(0.0) / given, 1.0, 0.15); // estimated
  // That of the vertices is less than half of it.
  EXPECT_GT(weight(level * run.GetBlock(0).Cells->Transfer.NoiseGain()) / given, 1.5);
}

TEST(CellData, ErrorsNameTheCell)
{
  const auto messageOf = [](const CellInput& input)
  {
    SurfaceDiffusion::Run run(SerialFor());
    try
    {
      HeatSettings settings;
      settings.FidelityWeight = 1.0;
      StateOf(run, { input.Block() }, settings);
    }
    catch (const std::runtime_error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const CellInput good(Torus(16, 10));
  EXPECT_EQ(messageOf(good), "");
  CellInput bad = good;
  bad.Data.Data.Values(5, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(messageOf(bad), "InputArray is infinite at cell 5; allowed: finite values and NaN");
  bad = good;
  bad.Data.Data.Values(5, 0) = NaN;
  bad.Data.Fixed.Values.assign(static_cast<std::size_t>(bad.Data.NumberOfCells), 1);
  bad.Data.Fixed.OnCells = true;
  EXPECT_NE(messageOf(bad).find("is NaN where FixedArray holds it at cell 5"), std::string::npos);
  bad = good;
  bad.Data.FidelityFactors.Values.assign(static_cast<std::size_t>(bad.Data.NumberOfCells), 1.0);
  bad.Data.FidelityFactors.Values[8] = -1.0;
  bad.Data.FidelityFactors.OnCells = true;
  EXPECT_EQ(messageOf(bad),
    "FidelityArray is -1 at cell 8; allowed: finite numbers, 0 or more (if it stands for no value, "
    "set 0 in its place)");
}

} // namespace SurfaceDiffusion
