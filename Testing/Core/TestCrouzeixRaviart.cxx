// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MeanCorrection.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// sum A_e w_e over the edges in units of the surface.
double EdgeTotal(const MedialMesh& edges, const Values& w)
{
  return 4.0 * Total(*edges.Edges(), w, 0);
}

Values EdgeMeans(const MedialMesh& edges, const Values& u)
{
  Values w(static_cast<Eigen::Index>(edges.Ends().size()), u.cols());
  for (Eigen::Index e = 0; e < w.rows(); ++e)
  {
    w.row(e) = 0.5 * (u.row(edges.Ends()[e][0]) + u.row(edges.Ends()[e][1]));
  }
  return w;
}

} // namespace

TEST(CrouzeixRaviart, WayBackIsExactForMeansAndKeepsTheSum)
{
  for (const Surface& s : { Icosphere(3), Disk(8), ThreeFins(6) })
  {
    const auto mesh = MakeMesh(s);
    const MedialMesh edges(*mesh);
    const Values u = Noise(*mesh, 2);
    Values back(u.rows(), 2);
    VerticesFromEdges(*mesh, edges, EdgeMeans(edges, u), back);
    EXPECT_LT((back - u).cwiseAbs().maxCoeff(), 1e-13);

    const Values w = Noise(*edges.Edges());
    Values v(u.rows(), 1);
    VerticesFromEdges(*mesh, edges, w, v);
    EXPECT_NEAR(Total(*mesh, v, 0), EdgeTotal(edges, w), 1e-13);
  }
}

TEST(CrouzeixRaviart, SmoothDataAndNoiseStartFromMeans)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const MedialMesh edges(assembler->Mesh());
  const Values smooth = Sample(assembler->Mesh(), s,
    [](const Eigen::RowVector3d& x) { return std::sin(3.0 * x[0]) + x[1] * x[2]; });
  EXPECT_LT(
    (EdgesFromVertices(*assembler, edges, smooth) - EdgeMeans(edges, smooth)).cwiseAbs().maxCoeff(),
    1e-15);

  const Values noise = Noise(assembler->Mesh());
  const Values change = EdgesFromVertices(*assembler, edges, noise) - EdgeMeans(edges, noise);
  EXPECT_LT(RootMeanSquare(*edges.Edges(), change), 0.1 * RootMeanSquare(assembler->Mesh(), noise));
}

/// Of edges between two kinds of vertices.
TEST(CrouzeixRaviart, EdgesAreKnownIfBothEndsAreAndFixedIfBothAre)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  const auto edges = std::make_shared<MedialMesh>(mesh);
  const auto onEdges = std::make_shared<Assembler>(edges->Edges());
  PointData data = PointData::FromValues(Noise(mesh));
  data.FidelityFactors.resize(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    data.Missing[i] = i % 5 == 1;
    data.Fixed[i] = i % 3 == 0 && i % 5 != 1;
    data.FidelityFactors[i] = i % 4;
  }
  const PointData given = data;
  PointData ofEdges;
  CrouzeixRaviartModel model(assembler, edges, std::move(data), TotalCorrection(),
    [&](PointData edgeData)
    {
      ofEdges = edgeData;
      return MakeExact(onEdges, std::move(edgeData), ExactSettings(mesh, 0.01, 1.0));
    });
  int mixed = 0;
  for (Index e = 0; e < edges->Edges()->NumberOfVertices(); ++e)
  {
    const Index i = edges->Ends()[e][0];
    const Index j = edges->Ends()[e][1];
    EXPECT_EQ(ofEdges.Missing[e], given.Missing[i] || given.Missing[j]);
    EXPECT_EQ(ofEdges.Fixed[e], given.Fixed[i] && given.Fixed[j]);
    mixed += given.Missing[i] != given.Missing[j] && given.Fixed[i] != given.Fixed[j];
    const double a = given.FidelityFactor(i), b = given.FidelityFactor(j);
    EXPECT_DOUBLE_EQ(ofEdges.FidelityFactors[e], a * b > 0.0 ? 2.0 / (1.0 / a + 1.0 / b) : 0.0);
  }
  EXPECT_GT(mixed, 10);
}

TEST(CrouzeixRaviart, JumpsStartSharp)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const MedialMesh edges(assembler->Mesh());
  const Values cap = Cap(assembler->Mesh(), s, 1.0);
  const Values w = EdgesFromVertices(*assembler, edges, cap);
  int wrong = 0, crossing = 0;
  for (Eigen::Index e = 0; e < w.rows(); ++e)
  {
    EXPECT_GE(w(e, 0), 0.0);
    EXPECT_LE(w(e, 0), 1.0);
    Eigen::RowVector3d x[2];
    for (int end = 0; end < 2; ++end)
    {
      x[end] = s.Vertices.row(assembler->Mesh().InputVertex()[edges.Ends()[e][end]]);
    }
    const Eigen::RowVector3d middle = (x[0] + x[1]).normalized();
    crossing += cap(edges.Ends()[e][0], 0) != cap(edges.Ends()[e][1], 0);
    wrong += std::abs(w(e, 0) - (std::acos(middle[2]) < 1.0 ? 1.0 : 0.0)) > 0.1;
  }
  EXPECT_GT(crossing, 100);
  EXPECT_LT(wrong, crossing / 4); // the means are wrong at all of them
}

TEST(CrouzeixRaviart, CapFlowsToHalfAPercentOnAnyTurnOfTheMesh)
{
  for (const auto& [turn, angle, time] :
    { std::array<double, 3>{ 0.0, Pi / 3.0, 0.2 }, { 0.7, 1.4, 0.1 } })
  {
    const Surface s = Rotated(Icosphere(5), turn); // 10,242 vertices
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const PointData data = PointData::FromValues(Cap(mesh, s, angle));
    const auto flow = MakeOnEdges(assembler, data, ExactSettings(mesh, time));
    flow->Advance(ProgressMonitor());
    const Plateaus plateaus = MeasurePlateaus(mesh, s, flow->State(), angle);
    EXPECT_LT(PlateauError(plateaus, ExactPlateaus(angle, time)), 0.005) << turn;
    const double jump = plateaus.Inside - plateaus.Outside;
    EXPECT_LT(flow->State().maxCoeff(), plateaus.Inside + 0.1 * jump);
    EXPECT_GT(flow->State().minCoeff(), plateaus.Outside - 0.1 * jump);
    EXPECT_NEAR(Total(mesh, flow->State(), 0), Total(mesh, data.Start, 0), 1e-12);
  }
}

TEST(CrouzeixRaviart, SteadyPlateausAreExactToHalfAPercent)
{
  const double angle = Pi / 3.0;
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Cap(mesh, s, angle));
  const auto flow = MakeOnEdges(assembler, data, ExactSettings(mesh, 0.0, 10.0));
  flow->Advance(ProgressMonitor());
  EXPECT_LT(
    PlateauError(MeasurePlateaus(mesh, s, flow->State(), angle), ExactPlateaus(angle, 0.1)), 0.005);
  EXPECT_NEAR(Total(mesh, flow->State(), 0), Total(mesh, data.Start, 0), 1e-12);
}

TEST(CrouzeixRaviart, NothingOfAJumpIsLeftInTheEnd)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values caps(mesh.NumberOfVertices(), 2);
  caps << Cap(mesh, s, Pi / 3.0), 0.1 * Cap(mesh, s, 1.4) + 0.01 * Noise(mesh);
  for (const bool masked : { false, true })
  {
    PointData data = PointData::FromValues(caps);
    if (masked)
    {
      data.Missing.head(200) = true;
    }
    for (const ChannelCoupling coupling : { ChannelCoupling::Joint, ChannelCoupling::PerChannel })
    {
      auto settings = ExactSettings(mesh, 100.0);
      settings.Coupling = coupling;
      const auto flow = MakeOnEdges(assembler, data, settings);
      flow->Advance(ProgressMonitor());
      for (Eigen::Index k = 0; k < 2; ++k)
      {
        const double mean = Total(mesh, caps, k) / mesh.ControlAreas().sum();
        EXPECT_LT((flow->State().col(k).array() - mean).abs().maxCoeff(), 1e-6) << k << masked;
        EXPECT_NEAR(Total(mesh, flow->State(), k), Total(mesh, caps, k), 1e-12);
      }
    }
  }
}

TEST(CrouzeixRaviart, EdgesKeepTheSumOfAJump)
{
  for (const double turn : { 0.0, 0.7, 1.9 })
  {
    const Surface s = Rotated(Icosphere(4), turn);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const MedialMesh edges(mesh);
    const Values cap = Cap(mesh, s, Pi / 3.0);
    const double perimeterTimesEdge = 2.0 * Pi * std::sin(Pi / 3.0) * MeanEdge(mesh);
    EXPECT_NEAR(EdgeTotal(edges, EdgesFromVertices(*assembler, edges, cap)), Total(mesh, cap, 0),
      0.03 * perimeterTimesEdge); // means have no error, but no edge; 0.1 without balance
  }
}

TEST(CrouzeixRaviart, NoiseDoesNotComeBack)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(0.3 * Noise(mesh));
  const auto flow = MakeOnEdges(assembler, data, ExactSettings(mesh, 0.05));
  flow->Advance(ProgressMonitor());
  EXPECT_LT(RootMeanSquare(mesh, flow->State()), 0.03 * RootMeanSquare(mesh, data.Start));
}
