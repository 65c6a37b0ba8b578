// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The detail of cells that points do not resolve diffuses, too.

#include "CellRun.h"
#include "Hubs.h"
#include "MeshFiles.h"
#include "Meshes.h"

#include "Core/Operators/CellFluxes.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

using namespace Testing;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

HeatSettings Heat(double timeStep, int steps, TimeIntegrator integrator)
{
  HeatSettings settings;
  settings.TimeStep = timeStep;
  settings.NumberOfTimeSteps = steps;
  settings.TimeIntegrator = integrator;
  settings.Tolerance = 1e-10;
  return settings;
}

Values WhiteNoise(Index count, Eigen::Index columns = 1)
{
  Values noise(count, columns);
  for (Index c = 0; c < count; ++c)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      noise(c, k) = std::sqrt(3.0) * (2.0 * UniformRandom(11, static_cast<Index>(k), c) - 1.0);
    }
  }
  return noise;
}

/// Surfaces of triangles, of quads and of two components of other sizes, in no order.
std::vector<CellInput> Shapes()
{
  std::vector<CellInput> shapes;
  shapes.emplace_back(Icosphere(3));
  const Testing::Surface torus = Rotated(Torus(24, 14));
  shapes.emplace_back(torus, CellsOfQuads(torus));
  const Testing::Surface both = Joined(Torus(20, 12), Moved(Icosphere(2, 0.5), { 6.0, 0.0, 0.0 }));
  shapes.emplace_back(Renumbered(both, Permutation(static_cast<Index>(both.Vertices.rows()), 3)));
  return shapes;
}

/// The full width at half maximum of the Gaussian that spreads white noise as f does: f is that of
/// an impulse of integral 1, and a Gaussian of time t has the integral 1/(8 pi t) of its square.
double Width(const Vector& areas, const Values& f)
{
  const double time = 1.0 / (8.0 * Pi * areas.dot(f.col(0).cwiseAbs2()));
  return std::sqrt(16.0 * std::log(2.0) * time);
}

/// By how much values leave the range of others, relative to it.
double Excess(const Values& values, const Values& data)
{
  const double range = data.maxCoeff() - data.minCoeff();
  return std::max(values.maxCoeff() - data.maxCoeff(), data.minCoeff() - values.minCoeff()) / range;
}

Values ResultAt(SurfaceDiffusion::Run& run, const CellInput& input, int step)
{
  run.Seek(step, ProgressMonitor());
  return MakeCellResult(
    *run.GetBlock(0).Cells, run.GetBlock(0).Path->State(), input.Data.Data.Values, true);
}

template <typename ModelSettings>
void Start(SurfaceDiffusion::Run& run, const CellInput& input, const ModelSettings& settings)
{
  run.Update(
    { input.Block() }, std::make_shared<ModelSettings>(settings), Alone, ProgressMonitor());
}

SparseMatrix OutflowsOf(const Testing::Surface& surface, const std::vector<Index>& cells)
{
  const TriangleMesh mesh(surface.Vertices, surface.Faces);
  CellFluxes fluxes(mesh, surface.Vertices, cells, cells.back() + 1, SerialFor());
  fluxes.SetUnitDiffusion();
  SparseMatrix plain;
  fluxes.Assemble(Vector::Zero(fluxes.NumberOfCells()), 1.0, plain);
  fluxes.SetWeights(CotanWeights(mesh));
  SparseMatrix weighted;
  fluxes.Assemble(Vector::Zero(fluxes.NumberOfCells()), 1.0, weighted);
  EXPECT_LT((plain - weighted).norm(), 1e-9 * plain.norm());
  return plain;
}

} // namespace

TEST(CellFluxes, OfSquaresAreTheFivePointFormula)
{
  const Testing::Surface strip = Strip(6, 5, 6.0, 5.0);
  const Eigen::MatrixXd l = OutflowsOf(strip, CellsOfQuads(strip));
  for (Eigen::Index i = 0; i < l.rows(); ++i)
  {
    for (Eigen::Index j = 0; j < l.cols(); ++j)
    {
      const auto distance = std::abs(i % 6 - j % 6) + std::abs(i / 6 - j / 6);
      if (i != j)
      {
        EXPECT_NEAR(l(i, j), distance == 1 ? -1.0 : 0.0, 1e-12);
      }
    }
  }
}

TEST(CellFluxes, MakeAnMMatrixOnAnySurface)
{
  for (const Testing::Surface& surface : { Icosphere(2), Rotated(Torus(7, 40)), Moebius(20, 3),
         ThreeFins(5), Jittered(Strip(12, 9), 0.04, 0.01, 0.99, 0.01, 0.99) })
  {
    const CellInput triangles(surface);
    const Eigen::MatrixXd l = OutflowsOf(surface, triangles.Data.Cells);
    EXPECT_EQ(l, l.transpose());
    EXPECT_LT(l.colwise().sum().cwiseAbs().maxCoeff(), 1e-12 * l.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < l.rows(); ++i)
    {
      EXPECT_GT(l(i, i), 0.0);
      EXPECT_LE((l.row(i).array() > 0.0).count(), 1);
    }
  }
}

// The matrix of 200 cells at an edge would have 40,000 entries. Without the unknown it is that of the fluxes
// t t / (200 t) between each two of them, with t = 3 as centroids are 1/3 from the edge of length 1.
TEST(CellFluxes, AtAnEdgeOfManyTrianglesHaveAnUnknown)
{
  constexpr Index n = 200;
  const Testing::Surface surface = TrianglesAtAnEdge(n);
  const Eigen::MatrixXd l = OutflowsOf(surface, CellInput(surface).Data.Cells);
  ASSERT_EQ(l.rows(), n + 1);
  EXPECT_EQ((l.array() != 0.0).count(), 3 * n + 1);
  const Eigen::MatrixXd fluxes =
    l.topLeftCorner(n, n) - l.topRightCorner(n, 1) * l.bottomLeftCorner(1, n) / l(n, n);
  const Eigen::MatrixXd expected =
    3.0 * (Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / n));
  EXPECT_LT((fluxes - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CellDetail, ImpulsesSpreadAsWidelyAsOnPoints)
{
  for (const auto integrator :
    { TimeIntegrator::FirstOrder, TimeIntegrator::SecondOrder, TimeIntegrator::Exponential })
  {
    for (const bool quads : { false, true })
    {
      const Testing::Surface surface = quads ? Torus(64, 32) : Icosphere(4);
      CellInput cells(surface, quads ? CellsOfQuads(surface) : std::vector<Index>());
      RunInput points(surface);
      for (const double timeStep : { 0.3, 1.0, 3.0 })
      {
        const HeatSettings settings = Heat(timeStep, 10, integrator);
        double ofCells = 0.0, ofPoints = 0.0;
        for (const Index place : { 3, 500, 777, 1200 })
        {
          SurfaceDiffusion::Run run(SerialFor()), other(SerialFor());
          cells.Data.Data.Values.setZero();
          cells.Data.Data.Values(place, 0) = 1.0;
          const Values onCells = CellResultOf(run, cells, settings);
          const CellTransfer& transfer = run.GetBlock(0).Cells->Transfer;
          ofCells += Width(transfer.CellAreas(), onCells / transfer.CellAreas()[place]);
          points.Data.Data.Values.setZero();
          points.Data.Data.Values(place, 0) = 1.0;
          const Values onPoints = StateOf(other, { points.Block() }, settings);
          const Vector& areas = other.GetBlock(0).Surface->Mesh().ControlAreas();
          ofPoints += Width(areas, onPoints / areas.dot(onPoints.col(0)));
        }
        EXPECT_NEAR(ofCells / ofPoints, 1.0, timeStep < 1.0 ? 0.06 : 0.03) << timeStep << quads;
      }
    }
  }
}

TEST(CellDetail, WhiteNoiseLeavesAtTheDefaultsOfHeat)
{
  for (CellInput& input : Shapes())
  {
    input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells);
    SurfaceDiffusion::Run run(SerialFor());
    const Values result = CellResultOf(run, input, HeatSettings());
    const Vector& areas = run.GetBlock(0).Cells->Transfer.CellAreas();
    EXPECT_LT(Deviation(areas, result), 0.12 * Deviation(areas, input.Data.Data.Values));
  }
}

TEST(CellDetail, OneExponentialStepIsThatOfManySteps)
{
  CellInput input(Icosphere(4));
  input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells, 2);
  for (const double time : { 0.3, 2.0, 8.0, 30.0 }) // widths of 2, 5, 9 and 18 edges
  {
    SurfaceDiffusion::Run run(SerialFor());
    const Values exact =
      CellResultOf(run, input, Heat(time / 400, 400, TimeIntegrator::SecondOrder));
    const Vector areas = run.GetBlock(0).Cells->Transfer.CellAreas();
    const Values one = CellResultOf(run, input, Heat(time, 1, TimeIntegrator::Exponential));
    EXPECT_LT(Deviation(areas, one - exact), 0.01 * Deviation(areas, exact)) << time;
  }
}

/// A constant with noise, on which all models remove noise without an edge in their way.
TEST(CellDetail, WhiteNoiseLeavesInAllModels)
{
  for (CellInput& input : Shapes())
  {
    input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells);
    const auto left = [&](const auto& settings)
    {
      SurfaceDiffusion::Run run(SerialFor());
      const Values result = CellResultOf(run, input, settings);
      const CellState& cells = *run.GetBlock(0).Cells;
      const Values smooth =
        MakeCellResult(cells, run.GetBlock(0).Path->State(), input.Data.Data.Values, false);
      const Vector& areas = cells.Transfer.CellAreas();
      return Deviation(areas, result - smooth) / Deviation(areas, input.Data.Data.Values);
    };
    HeatSettings steady;
    steady.Mode = HeatMode::SteadyState;
    EXPECT_LT(left(steady), 1e-9);
    steady.FidelityWeight = 0.1;
    EXPECT_LT(left(steady), 0.05);
    TotalVariationSettings variation;
    EXPECT_LT(left(variation), 0.2);
    variation.Discretization = Discretization::CrouzeixRaviart;
    EXPECT_LT(left(variation), 0.2);
    variation.Discretization = Discretization::Linear;
    variation.Mode = TotalVariationMode::SteadyState;
    variation.FidelityWeight = 0.3;
    EXPECT_LT(left(variation), 0.1);
    variation.FidelityNorm = FidelityNorm::L1;
    EXPECT_LT(left(variation), 0.3);
    MumfordShahSettings shah;
    shah.FidelityWeight = 0.1;
    EXPECT_LT(left(shah), 0.1);
    TensorDiffusionSettings tensor;
    EXPECT_LT(left(tensor), 0.1);
    tensor.Model = TensorModel::EdgeEnhancing;
    EXPECT_LT(left(tensor), 0.3);
  }
}

TEST(CellDetail, TheResultKeepsTheRangeOfTheDataWherePointsDo)
{
  for (const bool quads : { false, true })
  {
    const Testing::Surface surface = quads ? Strip(30, 24, 30.0, 24.0) : Icosphere(3);
    CellInput input(surface, quads ? CellsOfQuads(surface) : std::vector<Index>());
    const Values noise = WhiteNoise(input.Data.NumberOfCells);
    const Points centres = input.Centres();
    const double middle = centres.col(0).mean();
    for (const int kind : { 0, 1, 2, 3 })
    {
      input.SetData(
        [&](Index c, const Eigen::RowVector3d& x)
        {
          const double chance = noise(c, 0) / (2.0 * std::sqrt(3.0)) + 0.5;
          const double values[] = { x[0] > middle ? 1.0 : 0.0, chance < 0.1 ? 1.0 : 0.0,
            chance < 0.5 ? 1.0 : 0.0, c == 40 ? 1.0 : 0.0 };
          return values[kind];
        });
      for (const double timeStep : { 0.003, 0.03, 0.3, 3.0 })
      {
        SurfaceDiffusion::Run run(SerialFor());
        Start(run, input, Heat(timeStep, 8, TimeIntegrator::FirstOrder));
        const Vector& areas = run.GetBlock(0).Cells->Transfer.CellAreas();
        for (int step = 1; step <= 8; ++step)
        {
          const Values result = ResultAt(run, input, step);
          EXPECT_LT(Excess(result, input.Data.Data.Values), 1e-12)
            << quads << ' ' << kind << ' ' << timeStep << ' ' << step;
          EXPECT_NEAR(
            areas.dot((result - input.Data.Data.Values).col(0)), 0.0, 1e-12 * areas.sum());
        }
      }
    }
  }
}

TEST(CellDetail, TotalsOfEachComponentAreKept)
{
  for (CellInput& input : Shapes())
  {
    input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells, 2).array() + 0.3;
    const auto check = [&](const auto& settings)
    {
      SurfaceDiffusion::Run run(SerialFor());
      const Values result = CellResultOf(run, input, settings);
      const CellTransfer& cells = run.GetBlock(0).Cells->Transfer;
      const TriangleMesh& mesh = run.GetBlock(0).Surface->InputMesh();
      for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
      {
        std::vector<char> isHere(static_cast<std::size_t>(cells.NumberOfCells()), 0);
        for (Index i = mesh.ComponentsBegin()[c]; i < mesh.ComponentsBegin()[c + 1]; ++i)
        {
          cells.ForEachCellAround(
            i, [&](Index cell) { isHere[static_cast<std::size_t>(cell)] = 1; });
        }
        Eigen::RowVector2d change = Eigen::RowVector2d::Zero();
        double size = 0.0;
        for (Index cell = 0; cell < cells.NumberOfCells(); ++cell)
        {
          if (isHere[static_cast<std::size_t>(cell)] != 0)
          {
            const double area = cells.CellAreas()[cell];
            change += area * (result.row(cell) - input.Data.Data.Values.row(cell));
            size += area * input.Data.Data.Values.row(cell).norm();
          }
        }
        EXPECT_LT(change.norm(), 1e-12 * size);
      }
    };
    HeatSettings heat;
    check(heat);
    heat.IntrinsicDelaunay = true;
    check(heat);
    heat.FidelityWeight = 0.2;
    check(heat);
    heat.Mode = HeatMode::SteadyState;
    check(heat);
    TotalVariationSettings variation;
    check(variation);
    variation.ChannelCoupling = ChannelCoupling::PerChannel;
    check(variation);
    TensorDiffusionSettings tensor;
    tensor.Model = TensorModel::EdgeEnhancing;
    check(tensor);
  }
}

/// The fidelity to cells is to their changes: absolute values are in no model of the detail.
TEST(CellDetail, ResultOfAbsoluteFidelityMovesWithAConstant)
{
  CellInput input(Icosphere(3));
  const Values noise = WhiteNoise(input.Data.NumberOfCells);
  input.Data.Data.Values += noise;
  TotalVariationSettings settings;
  settings.NumberOfTimeSteps = 3;
  settings.FidelityWeight = 0.5;
  settings.AutomaticFidelity = false;
  settings.FidelityNorm = FidelityNorm::L1;
  const Values before = CellResultOf(input, settings);
  EXPECT_GT((before - input.Data.Data.Values).cwiseAbs().maxCoeff(), 0.1);
  input.Data.Data.Values.array() += 64.0;
  const Values after = CellResultOf(input, settings);
  EXPECT_LT(((after - before).array() - 64.0).abs().maxCoeff(), 1e-3);
}

TEST(CellDetail, TimeStepsTendToTheSteadyState)
{
  for (CellInput& input : Shapes())
  {
    input.Data.Data.Values += 0.3 * WhiteNoise(input.Data.NumberOfCells);
    input.Data.Data.Values(5, 0) = NaN;
    HeatSettings settings = Heat(1e4, 6, TimeIntegrator::FirstOrder);
    settings.FidelityWeight = 0.2;
    const Values late = CellResultOf(input, settings);
    settings.Mode = HeatMode::SteadyState;
    const Values steady = CellResultOf(input, settings);
    EXPECT_LT((late - steady).cwiseAbs().maxCoeff(), 1e-6);
    // Data that are pulled strongly enough stay.
    settings.FidelityWeight = 1e6;
    Values change = CellResultOf(input, settings) - input.Data.Data.Values;
    change(5, 0) = 0.0;
    EXPECT_LT(change.cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(CellDetail, ColumnsOfTheirOwnWeightsAreAsIfAlone)
{
  CellInput input(Joined(Torus(20, 12), Moved(Icosphere(3), { 6.0, 0.0, 0.0 })));
  const Index count = input.Data.NumberOfCells;
  const Values noise = WhiteNoise(count, 2);
  const Values ofBoth = input.Data.Data.Values;
  Values data(count, 2);
  for (Index c = 0; c < count; ++c)
  {
    const bool isSphere = c >= 2 * 20 * 12;
    data(c, 0) = ofBoth(c, 0) + 0.1 * noise(c, 0);
    data(c, 1) = ofBoth(c, 0) + (isSphere ? 0.6 : 0.1) * noise(c, 1);
  }
  HeatSettings settings;
  settings.Units = UnitsMode::Absolute;
  settings.Mode = HeatMode::SteadyState;
  settings.AutomaticFidelity = true;
  input.Data.Data.Values = data;
  const Values together = CellResultOf(input, settings);
  for (Eigen::Index k = 0; k < 2; ++k)
  {
    input.Data.Data.Values = data.col(k);
    const Values alone = CellResultOf(input, settings);
    EXPECT_LT((together.col(k) - alone).cwiseAbs().maxCoeff(), 1e-6) << k;
  }
}

TEST(CellDetail, FlowsThroughEdgesOfManyTriangles)
{
  CellInput input(ThreeFins(10));
  input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells);
  SurfaceDiffusion::Run run(SerialFor());
  const Values result = CellResultOf(run, input, Heat(1e5, 3, TimeIntegrator::FirstOrder));
  const Vector& areas = run.GetBlock(0).Cells->Transfer.CellAreas();
  EXPECT_LT(Deviation(areas, result), 1e-3);
}

TEST(CellDetail, OfDirectionsLeavesLessThanItsNoise)
{
  for (const bool lines : { false, true })
  {
    CellInput input(Icosphere(3));
    const Values noise = WhiteNoise(input.Data.NumberOfCells);
    input.Data.Data.Values.resize(input.Data.NumberOfCells, 3);
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      const double sign = lines && c % 3 == 0 ? -1.0 : 1.0;
      input.Data.Data.Values.row(c) << sign * std::cos(0.2 * noise(c, 0)),
        sign * std::sin(0.2 * noise(c, 0)), 0.0;
    }
    HarmonicMapSettings settings;
    settings.LineField = lines;
    const Values result = CellResultOf(input, settings);
    EXPECT_LT(result.col(1).norm(), 0.15 * input.Data.Data.Values.col(1).norm());
    for (Index c = 0; c < input.Data.NumberOfCells; ++c)
    {
      EXPECT_NEAR(result.row(c).norm(), 1.0, 1e-14);
      EXPECT_GT(result.row(c).dot(input.Data.Data.Values.row(c)), 0.8);
    }
  }
}

TEST(CellDetail, OfAScanLeaves)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "SURFACEDIFFUSION_MESH_DIR is not set";
  }
  for (const char* name : { "cow", "mannequin-devil", "cross_quad" })
  {
    CellInput input(ReadMeshFile(name));
    input.Data.Data.Values = WhiteNoise(input.Data.NumberOfCells);
    for (const bool delaunay : { false, true })
    {
      HeatSettings settings;
      settings.IntrinsicDelaunay = delaunay;
      SurfaceDiffusion::Run run(SerialFor());
      const Values result = CellResultOf(run, input, settings);
      const CellState& cells = *run.GetBlock(0).Cells;
      const Values smooth =
        MakeCellResult(cells, run.GetBlock(0).Path->State(), input.Data.Data.Values, false);
      const Vector& areas = cells.Transfer.CellAreas();
      EXPECT_LT(Deviation(areas, result - smooth), 0.05 * Deviation(areas, input.Data.Data.Values));
    }
  }
}

} // namespace SurfaceDiffusion
