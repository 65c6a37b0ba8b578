// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/StructureDiffusion.h"
#include "Core/Operators/GradientTensor.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Surface/TangentVectors.h"
#include "EveryMeshFile.h"
#include "Heat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = StructureDiffusion::Kind;
using Settings = StructureDiffusion::Settings;

constexpr Kind BothKinds[] = { Kind::CoherenceEnhancing, Kind::EdgeEnhancing };

struct Scales
{
  double Noise = 1.0, Integration = 4.0; ///< in mean edge lengths; 0: off
};

std::unique_ptr<StructureTensor> MakeStructure(std::shared_ptr<const Assembler> assembler,
  Scales scales = {}, double tolerance = 1e-6, const ParallelFor& parallel = SerialFor())
{
  const auto mesh = assembler->SharedMesh();
  const double width = WidthOfDeviation * MeanEdge(*mesh);
  std::unique_ptr<HeatBlur> noise;
  if (scales.Noise > 0.0)
  {
    noise = std::make_unique<HeatBlur>(
      assembler, scales.Noise * width, 2, Iterative(tolerance, parallel), parallel);
  }
  std::unique_ptr<TensorSmoothing> integration;
  if (scales.Integration > 0.0)
  {
    integration = std::make_unique<TensorSmoothing>(std::make_shared<LineFieldOperator>(mesh),
      scales.Integration * width, 2, Iterative(tolerance, parallel), parallel);
  }
  return std::make_unique<StructureTensor>(
    mesh, std::move(noise), std::move(integration), parallel);
}

/// Time steps in h^2 for values in a range of 1.
Settings NaturalSettings(const TriangleMesh& mesh, Kind kind, double timeStep)
{
  const double h = MeanEdge(mesh);
  Settings settings;
  settings.TimeStep = timeStep * h * h;
  settings.Model = kind;
  settings.Contrast = 0.05 / h;
  return settings;
}

std::unique_ptr<StructureDiffusion> MakeModel(std::shared_ptr<const Assembler> assembler,
  PointData data, const Settings& settings, double tolerance = 1e-6,
  const ParallelFor& parallel = SerialFor())
{
  auto structure = MakeStructure(assembler,
    { 1.0, settings.Model == Kind::CoherenceEnhancing ? 4.0 : 0.0 }, tolerance, parallel);
  return std::make_unique<StructureDiffusion>(std::move(assembler), TangentVectors(),
    std::move(data), settings, std::move(structure), Iterative(tolerance, parallel), parallel);
}

double GaussianNoise(std::int64_t seed, Index i)
{
  return std::sqrt(-2.0 * std::log(1.0 - UniformRandom(seed, 0, i))) *
    std::cos(2.0 * Pi * UniformRandom(seed, 1, i));
}

/// Stripes of 11 mean edge lengths that wind around a cylinder of radius 1 as helices.
class HelicalStripes
{
public:
  HelicalStripes()
    : Shape(Cylinder(120, 76, 1.0, 76 * 2.0 * Pi / 120))
    , Operators(MakeAssembler(this->Shape))
    , Mesh(this->Operators->Mesh())
    , EdgeLength(MeanEdge(this->Mesh) * this->Mesh.LengthUnit())
  {
    const double wave = 2.0 * Pi / (11.0 * this->EdgeLength);
    this->Along = std::sqrt(wave * wave - Around * Around);
  }

  Values Sine() const
  {
    return Sample(this->Mesh, this->Shape,
      [&](const Eigen::RowVector3d& x)
      { return std::sin(Around * std::atan2(x[1], x[0]) + this->Along * x[2]); });
  }

  /// Stripes of the range 1 with so much Gaussian noise.
  Values Data(double noise) const
  {
    Values u = 0.5 * this->Sine();
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      u(i, 0) += noise * GaussianNoise(5, this->Mesh.InputVertex()[i]);
    }
    return u;
  }

  /// The amplitude of the stripes in u relative to Data().
  double Contrast(const Values& u) const
  {
    const Values sine = this->Sine();
    const Vector weighted = this->Mesh.ControlAreas().cwiseProduct(sine.col(0));
    return weighted.dot(u.col(0)) / (0.5 * weighted.dot(sine.col(0)));
  }

  /// The mean angle between lines and the stripes, in degrees.
  double MeanError(const TangentVectors& lines) const
  {
    const Points vectors =
      VectorsInSpace(this->Mesh, this->Shape.Vertices, this->Shape.Faces, lines);
    double sum = 0.0;
    for (Index t = 0; t < this->Shape.NumberOfTriangles(); ++t)
    {
      Eigen::RowVector3d x = Eigen::RowVector3d::Zero();
      for (int a = 0; a < 3; ++a)
      {
        x += this->Shape.Vertices.row(this->Shape.Faces(t, a));
      }
      const double angle = std::atan2(x[1], x[0]);
      Eigen::RowVector3d across = { -Around * std::sin(angle), Around * std::cos(angle),
        this->Along };
      sum += std::asin(std::min(1.0, std::abs(across.normalized().dot(vectors.row(t)))));
    }
    return sum / this->Shape.NumberOfTriangles() * 180.0 / Pi;
  }

private:
  static constexpr double Around = 6.0;
  Surface Shape;

public:
  const std::shared_ptr<const Assembler> Operators;
  const TriangleMesh& Mesh;
  const double EdgeLength;

private:
  double Along = 0.0;
};

/// A flat torus without curvature: a sheet of cells x cells whose opposite borders are one.
std::shared_ptr<const TriangleMesh> FlatTorus(Index cells)
{
  const Surface sheet = Jittered(Plate(cells, 1.0), 0.3 / cells, -0.99, 0.99, -0.99, 0.99);
  const TriangleMesh flat(sheet.Vertices, sheet.Faces);
  TriangleMesh::Contents contents;
  contents.Shapes = flat.Shapes();
  contents.TriangleVertices = flat.TriangleVertices();
  for (Eigen::Index entry = 0; entry < contents.TriangleVertices.size(); ++entry)
  {
    Index& vertex = contents.TriangleVertices.data()[entry];
    const Index input = flat.InputVertex()[vertex];
    const Index column = input % (cells + 1);
    const Index row = input / (cells + 1);
    vertex = row % cells * cells + column % cells;
  }
  for (Index i = 0; i < cells * cells; ++i)
  {
    contents.InputVertex.push_back(i);
  }
  contents.InputTriangle = flat.InputTriangle();
  contents.ComponentsBegin = { 0, cells * cells };
  contents.LengthUnit = flat.LengthUnit();
  contents.TotalEdgeLength = flat.TotalEdgeLength();
  contents.NumberOfEdges = flat.NumberOfEdges();
  return std::make_shared<TriangleMesh>(std::move(contents));
}

} // namespace

TEST(StructureTensor, AcrossEdgesOfThreeTrianglesDoesNotDependOnTheAxes)
{
  const Surface s = ThreeFins(6);
  Vector expected;
  for (const double angle : { 0.0, 0.7, 2.0, 4.0 })
  {
    const Surface turned = Rotated(s, angle);
    const auto assembler = MakeAssembler(turned);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values u = Sample(mesh, s,
      [](const Eigen::RowVector3d& x) { return std::sin(6.0 * x[0] + 4.0 * x[1]) + x[2]; });
    const auto structure = MakeStructure(assembler, { 1.0, 2.0 }, 1e-12);
    StepReport report;
    structure->Evaluate(u, report, ProgressMonitor());
    Vector found(mesh.NumberOfTriangles());
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      found[mesh.InputTriangle()[t]] = structure->Deviators().row(t).norm();
    }
    expected = angle == 0.0 ? found : expected;
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.maxCoeff());
  }
}

TEST(StructureDiffusion, OrientationOfHelicalStripesIsFoundInNoise)
{
  const HelicalStripes stripes;
  for (const double noise : { 0.0, 0.3 })
  {
    const auto model = MakeModel(stripes.Operators, PointData::FromValues(stripes.Data(noise)),
      NaturalSettings(stripes.Mesh, Kind::CoherenceEnhancing, 1.0));
    const double start = stripes.MeanError(model->Axes());
    Advance(*model, 10);
    const double end = stripes.MeanError(model->Axes());
    std::printf("%g noise: %.3f degrees, after 10 h^2 %.3f\n", noise, start, end);
    EXPECT_LT(start, 2.0);
    EXPECT_LT(end, 2.0);
  }
}

TEST(StructureDiffusion, StripesKeepTheContrastThatIsotropicDiffusionLoses)
{
  const HelicalStripes stripes;
  const double time = 10.0 * stripes.EdgeLength * stripes.EdgeLength;
  for (const double noise : { 0.0, 0.3 })
  {
    const PointData data = PointData::FromValues(stripes.Data(noise));
    const auto model = MakeModel(
      stripes.Operators, data, NaturalSettings(stripes.Mesh, Kind::CoherenceEnhancing, 1.0));
    Advance(*model, 10);
    const double before = stripes.Contrast(data.Given);
    const double kept = stripes.Contrast(model->State()) / before;
    const double isotropic = stripes.Contrast(Diffuse(stripes.Operators, data, time, 10)) / before;
    const Values clean = stripes.Data(0.0);
    const double noiseLeft = RootMeanSquare(stripes.Mesh, model->State() - clean);
    std::printf("%g noise: kept %.4f, isotropic %.4f, error %.4f of %.4f\n", noise, kept, isotropic,
      noiseLeft, RootMeanSquare(stripes.Mesh, data.Given - clean));
    EXPECT_GT(kept, 0.95);
    EXPECT_LT(isotropic, 0.5);
  }
}

TEST(StructureDiffusion, ConstantTensorFieldsOnTheFlatTorusStay)
{
  const auto torus = FlatTorus(20);
  const auto laplacian = std::make_shared<LineFieldOperator>(torus);
  TensorSmoothing smoothing(laplacian, 0.8 / torus->LengthUnit(), 2, Iterative(1e-14));
  // The same line in every triangle, in its own axes, which turn from triangle to triangle.
  const Surface sheet = Jittered(Plate(20, 1.0), 0.3 / 20, -0.99, 0.99, -0.99, 0.99);
  const TriangleMesh flat(sheet.Vertices, sheet.Faces);
  const Points directions =
    Eigen::RowVector3d(3.0, 1.0, 0.0).replicate(sheet.NumberOfTriangles(), 1);
  const TangentVectors lines =
    TangentVectorsFromTriangleVectors(flat, sheet.Vertices, sheet.Faces, directions);
  TangentVectors z(lines.rows(), 2);
  for (Eigen::Index t = 0; t < lines.rows(); ++t)
  {
    z.row(t) << std::pow(lines(t, 0), 2) - std::pow(lines(t, 1), 2),
      2.0 * lines(t, 0) * lines(t, 1);
  }
  const TangentVectors before = z;
  StepReport report;
  smoothing.Apply(z, report);
  EXPECT_LT((z - before).cwiseAbs().maxCoeff(), 1e-12);
  z.topRows(1).setZero(); // and others change
  smoothing.Apply(z, report);
  EXPECT_GT(z.row(0).norm(), 0.9);
}

TEST(StructureDiffusion, SmoothedTensorsDecayAsAPlaneWave)
{
  // z = exp(i k x) on the flat torus is an eigenfunction of the connection Laplacian.
  double errors[2];
  for (const int level : { 0, 1 })
  {
    const Index cells = 20 << level;
    const auto torus = FlatTorus(cells);
    const Surface sheet = Jittered(Plate(cells, 1.0), 0.3 / cells, -0.99, 0.99, -0.99, 0.99);
    const TriangleMesh flat(sheet.Vertices, sheet.Faces);
    const double width = 0.6, wave = Pi;
    TensorSmoothing smoothing(
      std::make_shared<LineFieldOperator>(torus), width / torus->LengthUnit(), 2, Iterative(1e-13));
    const auto field = [&](double factor)
    {
      TangentVectors z(flat.NumberOfTriangles(), 2);
      for (Index t = 0; t < flat.NumberOfTriangles(); ++t)
      {
        const Index input = flat.InputTriangle()[t];
        Eigen::RowVector3d x = Eigen::RowVector3d::Zero();
        for (int a = 0; a < 3; ++a)
        {
          x += sheet.Vertices.row(sheet.Faces(input, a)) / 3.0;
        }
        const auto axes = TriangleAxes(flat, sheet.Vertices, sheet.Faces, t);
        const double turn = std::atan2(axes(1, 0), axes(0, 0)); // of the triangle's axes
        const double orientation = axes(0, 0) * axes(1, 1) - axes(1, 0) * axes(0, 1);
        const double angle = orientation * (wave * x[0] - 2.0 * turn);
        z.row(t) << factor * std::cos(angle), factor * std::sin(angle);
      }
      return z;
    };
    TangentVectors z = field(1.0);
    StepReport report;
    smoothing.Apply(z, report);
    const double tau = HeatBlur::TimeOfWidth(width, 2);
    const double decay = std::pow(1.0 + 0.5 * tau * wave * wave, -2);
    errors[level] = (z - field(decay)).cwiseAbs().maxCoeff();
  }
  std::printf("plane wave to %.2e, %.2e\n", errors[0], errors[1]);
  EXPECT_LT(errors[1], 5e-3);
  EXPECT_GT(ObservedOrder(errors[0], errors[1]), 1.5);
}

TEST(StructureDiffusion, RotatedColorsGiveTheRotatedResult)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Noise(mesh, 3);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (const Kind kind : BothKinds)
  {
    const Settings settings = NaturalSettings(mesh, kind, 2.0);
    const auto model = MakeModel(assembler, PointData::FromValues(f), settings, 1e-13);
    const auto turned = MakeModel(assembler, PointData::FromValues(f * turn), settings, 1e-13);
    Advance(*model, 4);
    Advance(*turned, 4);
    EXPECT_LT((turned->State() - model->State() * turn).cwiseAbs().maxCoeff(), 1e-9);
  }
}

namespace
{

/// The diffusivities that the first step takes for the data (steep x, flat y) on a plate, from the
/// energies of x and y: int grad v . D grad v over the area is the diffusivity along grad v.
void ExpectDiffusivities(
  Settings settings, double steep, double flat, double acrossEdges, double alongEdges)
{
  const Surface s = Rotated(Jittered(Plate(6, 1.0), 0.08, -0.99, 0.99, -0.99, 0.99));
  const Surface plate = Jittered(Plate(6, 1.0), 0.08, -0.99, 0.99, -0.99, 0.99);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values f(mesh.NumberOfVertices(), 2);
  f << Sample(mesh, plate, [&](const Eigen::RowVector3d& x) { return steep * x[0]; }),
    Sample(mesh, plate, [&](const Eigen::RowVector3d& x) { return flat * x[1]; });
  settings.Contrast *= mesh.LengthUnit();
  StructureDiffusion model(assembler, TangentVectors(), PointData::FromValues(f), settings,
    MakeStructure(assembler, { 0.0, 0.0 }), MakeCholeskySolver());
  model.Advance(ProgressMonitor());
  const CornerWeights& weights = model.DiffusionWeights(0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto energy = [&](double ofX, double ofY)
    {
      const auto corners = mesh.TriangleVertices().row(t);
      double sum = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        const Index i = mesh.InputVertex()[corners[(a + 1) % 3]];
        const Index j = mesh.InputVertex()[corners[(a + 2) % 3]];
        const Eigen::RowVector3d edge = plate.Vertices.row(i) - plate.Vertices.row(j);
        sum += weights(t, a) * std::pow(ofX * edge[0] + ofY * edge[1], 2);
      }
      return sum / (mesh.Shapes()[t].Area() * mesh.LengthUnit() * mesh.LengthUnit());
    };
    EXPECT_NEAR(energy(1.0, 0.0), acrossEdges, 1e-9);
    EXPECT_NEAR(energy(0.0, 1.0), alongEdges, 1e-9);
    EXPECT_NEAR(energy(1.0, 1.0), acrossEdges + alongEdges, 1e-9); // no entry between the axes
  }
}

} // namespace

TEST(StructureDiffusion, EdgeEnhancingHasWeickertsDiffusivity)
{
  Settings settings;
  settings.Model = Kind::EdgeEnhancing;
  settings.Contrast = 1.3;
  for (const double steep : { 1.0, 1.3, 1.6, 2.0, 4.0 })
  {
    // m1 = steep^2 for any m2.
    const double flux = 3.31488 * std::pow(1.3 / steep, 8);
    for (const double flat : { 0.0, 0.4, 0.9 * steep })
    {
      ExpectDiffusivities(settings, steep, flat, 1.0 - std::exp(-flux), 1.0);
    }
  }
}

/// The factor 3.31488 makes s g(s^2) largest at s = K: there (1 + 8 c) exp(-c) = 1.
TEST(StructureDiffusion, FluxOfEdgeEnhancingIsLargestAtTheContrast)
{
  const double c = 3.31488;
  EXPECT_NEAR((1.0 + 8.0 * c) * std::exp(-c), 1.0, 1e-4);
}

TEST(StructureDiffusion, CoherenceEnhancingHasWeickertsDiffusivity)
{
  Settings settings;
  settings.Model = Kind::CoherenceEnhancing;
  settings.Contrast = 1.3;
  settings.Alpha = 0.02;
  for (const double steep : { 1.0, 1.3, 2.0, 4.0 })
  {
    for (const double flat : { 0.0, 0.7 * steep })
    {
      const double ratio = 1.3 * 1.3 / (steep * steep - flat * flat); // K^2/(m1 - m2)
      ExpectDiffusivities(settings, steep, flat, 0.02, 0.02 + 0.98 * std::exp(-ratio * ratio));
    }
  }
}

TEST(StructureDiffusion, AlphaOneIsLinearDiffusion)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Noise(mesh, 2));
  Settings settings = NaturalSettings(mesh, Kind::CoherenceEnhancing, 0.5);
  settings.Alpha = 1.0;
  const auto model = MakeModel(assembler, data, settings, 1e-12);
  Advance(*model, 4);
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  const Values linear =
    Diffuse(assembler, data, 2.0 * h * h, 4, 0.0, LinearDiffusion::Scheme::BackwardEuler);
  EXPECT_LT((model->State() - linear).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(StructureDiffusion, EdgeEnhancingKeepsAnEdgeAndSmoothsNoise)
{
  const Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values cap = Sample(mesh, s, [](const Eigen::RowVector3d& x) { return x[2] > 0.3; });
  const Values f = cap + 0.1 * Noise(mesh);
  const auto model =
    MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, Kind::EdgeEnhancing, 1.0));
  Advance(*model, 10);
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  const Values linear = Diffuse(assembler, PointData::FromValues(f), 10.0 * h * h, 10);
  const double error = RootMeanSquare(mesh, model->State() - cap);
  std::printf("error %.4f, linear %.4f, data %.4f\n", error, RootMeanSquare(mesh, linear - cap),
    RootMeanSquare(mesh, f - cap));
  EXPECT_LT(error, 0.5 * RootMeanSquare(mesh, linear - cap));
}

TEST(StructureDiffusion, VarianceNeverRisesOnScannedMeshes)
{
  ForEachMeshFile(
    [](const Surface& s)
    {
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      const Values f = 0.5 * Noise(mesh, 2);
      for (const Kind kind : BothKinds)
      {
        for (const double timeStep : { 2.0, 1e4 })
        {
          const auto model =
            MakeModel(assembler, PointData::FromValues(f), NaturalSettings(mesh, kind, timeStep));
          const double first = model->Energy();
          double last = first;
          for (int step = 0; step < 2; ++step)
          {
            model->Advance(ProgressMonitor());
            EXPECT_LE(model->Energy() - last, 1e-9 * first) << "step " << step;
            last = model->Energy();
          }
          EXPECT_TRUE(model->State().allFinite());
          for (int k = 0; k < 2; ++k)
          {
            const double scale = mesh.ControlAreas().dot(f.col(k).cwiseAbs());
            EXPECT_NEAR(Total(mesh, model->State(), k), Total(mesh, f, k), 1e-12 * scale);
          }
        }
      }
    });
}

/// With g1 = 0, nothing flows along the gradient. On triangles of 1 : 300, round-off of the entries
/// of D would.
TEST(StructureDiffusion, OneChannelOnThinTrianglesStaysWhereNothingFlowsAcrossEdges)
{
  const auto assembler = MakeAssembler(Cylinder(24, 40, 1.0, 40 * 300 * 2.0 * Pi / 24));
  Settings settings;
  settings.Model = Kind::EdgeEnhancing;
  settings.TimeStep = 1e8;
  settings.Contrast = 1e-30;
  StructureDiffusion model(assembler, TangentVectors(),
    PointData::FromValues(Noise(assembler->Mesh())), settings,
    MakeStructure(assembler, { 0.0, 0.0 }), MakeCholeskySolver());
  const double first = model.Energy();
  Advance(model, 2);
  EXPECT_NEAR(model.Energy(), first, 1e-3 * first);
}

TEST(StructureDiffusion, NeighbouringHugeValuesHaveAGradient)
{
  const auto assembler = MakeAssembler(Icosphere(0));
  const TriangleMesh& mesh = assembler->Mesh();
  double value = std::ldexp(1.999, 320);
  for (int run = 0; run < 100; ++run)
  {
    const double next = std::nextafter(value, 2.0 * value);
    Values u = Values::Constant(mesh.NumberOfVertices(), 2, value);
    u.row(mesh.TriangleVertices()(0, 1)).setConstant(next);
    const PlaneTensor sum = SumGradients(mesh, u, 0).T;
    EXPECT_TRUE(sum.Trace() > 0.0 && std::isfinite(sum.Trace())) << value;
    value = next;
  }
}
