// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomRun.h"

#include "RandomInput.h"

#include "Core/Models/BeltramiFlow.h"
#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Core/Models/Harmonic/UnitVectors.h"
#include "Core/Models/InitialState.h"
#include "Core/Models/Interpolation/InterpolationModel.h"
#include "Core/Models/LinearDiffusion.h"
#include "Core/Models/MumfordShah.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/Segmentation.h"
#include "Core/Models/StructureDiffusion.h"
#include "Core/Models/Textures/ReactionDiffusion.h"
#include "Core/Models/TikhonovDeblurring.h"
#include "Core/Models/TotalVariation/CrouzeixRaviart.h"
#include "Core/Models/TotalVariation/TotalVariationDeblurring.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Core/Surface/MedialMesh.h"
#include "Core/Surface/TangentVectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion::Testing
{

namespace
{

Points ReadPoints(Bytes& bytes)
{
  const int count = 3 + bytes.Below(18);
  const double scale = bytes.Flip(4) ? bytes.Size(150.0) : 1.0;
  const double offset = bytes.Flip(4) ? 1e6 * bytes.Short() : 0.0;
  const bool flat = bytes.Flip();
  const double unevenness = bytes.Flip() ? bytes.Size(14.0) : 1.0;
  Points points(count, 3);
  for (int i = 0; i < count; ++i)
  {
    points.row(i) << bytes.Below(5), bytes.Below(5), flat ? 0 : bytes.Below(3);
    if (bytes.Flip(3)) // near an earlier point: needles and slivers
    {
      points.row(i) = points.row(bytes.Below(i + 1));
      points(i, bytes.Below(3)) += bytes.Short() * std::min(unevenness, 1.0);
    }
  }
  return scale * (points.array() + offset).matrix();
}

Triangles ReadTriangles(Bytes& bytes, int points)
{
  const int count = bytes.Below(40);
  Triangles triangles(count, 3);
  for (int t = 0; t < count; ++t)
  {
    const int a = bytes.Below(points);
    // Mostly neighbouring vertices, so that triangles share edges.
    triangles.row(t) << a, (a + 1 + bytes.Below(3)) % points, bytes.Below(points);
  }
  return triangles;
}

/// Values between 10^-span and 10^span in size.
PointData ReadData(Bytes& bytes, const TriangleMesh& mesh, double span)
{
  const int columns = 1 + bytes.Below(4);
  const double scale = bytes.Flip(4) ? bytes.Size(span) : 1.0;
  const double offset = bytes.Flip(4) ? 1e6 * bytes.Short() : 0.0;
  const bool holes = bytes.Flip();
  const bool held = bytes.Flip(3);
  PointData data = PointData::FromValues(Values(mesh.NumberOfVertices(), columns));
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < columns; ++k)
    {
      data.Given(i, k) = scale * (bytes.Short() + offset);
    }
    data.Missing[i] = holes && bytes.Flip(3);
    data.Fixed[i] = held && !data.Missing[i] && bytes.Flip(4);
    if (data.Missing[i] && bytes.Flip())
    {
      data.Given(i, 0) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return data;
}

/// Read last, so that the bytes of earlier findings keep their meaning.
void ReadFidelityFactors(Bytes& bytes, PointData& data)
{
  if (bytes.Flip(4))
  {
    data.FidelityFactors.resize(data.Given.rows());
    for (double& factor : data.FidelityFactors)
    {
      factor = bytes.Flip(3) ? 0.0 : bytes.Size(2.0);
    }
  }
}

std::vector<std::int64_t> Ids(const TriangleMesh& mesh)
{
  std::vector<std::int64_t> ids(mesh.NumberOfVertices());
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

constexpr double SolverTolerance = 1e-10;

std::shared_ptr<LinearSolver> ReadSolver(Bytes& bytes)
{
  std::shared_ptr<LinearSolver> solver;
  if (bytes.Flip())
  {
    solver = MakeCholeskySolver();
  }
  else
  {
    solver = MakeConjugateGradientSolver();
  }
  solver->SetLimits({ SolverTolerance, 1000 });
  return solver;
}

EdgeFunction ReadEdgeFunction(Bytes& bytes)
{
  EdgeFunction function;
  function.Kind = static_cast<EdgeFunctionKind>(bytes.Below(6));
  function.Beta = bytes.Size(8.0);
  function.Threshold = bytes.Size(3.0);
  return function;
}

/// The invariants of a model. All its states must be finite in any case.
struct Promises
{
  bool Sum = false; ///< of A u
  bool Bounds = false; ///< of the start
  bool Energy = false; ///< does not grow
  bool Length = false; ///< every row is one long
  bool Solution = true; ///< the systems have one
  double Fidelity = 0.0; ///< lambda, in the unit of the energy
  double RoundOff = 1e-13; ///< of values, relative to the largest
  /// No energy is promised from the first step on whose report has a larger residual: the answer of
  /// a direct solve is used as it is, with a warning.
  double Residual = std::numeric_limits<double>::infinity();
  bool Variation = false; ///< the energy has a term that is linear in the differences of values
};

void CheckState(const TriangleMesh& mesh, const Model& model, const Values& start,
  double energyBefore, double energyAtStart, const Promises& promises)
{
  const Values& u = model.State();
  Require(u.allFinite(), "a state is not finite");
  const double energy = model.Energy();
  Require(std::isfinite(energy) || !promises.Energy, "an energy is not finite");
  // Even a constant has energy, by round-off, which the fidelity weight multiplies. An error of energy
  // e adds up to e + 2 sqrt(e E) to an energy E.
  const double largest = u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0.0;
  const double error = promises.RoundOff * largest * std::sqrt(1.0 + promises.Fidelity);
  const double roundOff = 1e-9 * energyAtStart +
    error * (error + 2.0 * std::sqrt(std::max(energyAtStart, 0.0))) +
    (promises.Variation ? promises.RoundOff * largest * mesh.TotalEdgeLength() : 0.0) +
    std::numeric_limits<double>::min();
  Require(!promises.Energy || energy <= energyBefore + roundOff, "an energy grows");
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    const double size = Total(mesh, start.cwiseAbs(), k);
    Require(!promises.Sum || std::abs(Total(mesh, u, k) - Total(mesh, start, k)) <= 1e-12 * size,
      "a sum is not kept");
    if (promises.Bounds && u.rows() > 0)
    {
      const double low = start.col(k).minCoeff();
      const double high = start.col(k).maxCoeff();
      const double slack = 1e-8 * (high - low) + 1e-13 * start.col(k).cwiseAbs().maxCoeff();
      Require(u.col(k).minCoeff() >= low - slack && u.col(k).maxCoeff() <= high + slack,
        "bounds are not kept");
    }
  }
  Require(!promises.Length || u.rows() == 0 ||
      (u.rowwise().norm().array() - 1.0).abs().maxCoeff() < 1e-12,
    "a vector is not one long");
}

/// Three steps, of which the last is repeated from the saved state. Returns whether all have a
/// result.
bool Run(const TriangleMesh& mesh, Model& model, Promises promises)
{
  const Values start = model.State();
  const double energy = model.Energy();
  CheckState(mesh, model, start, energy, energy, promises);
  std::vector<double> checkpoint;
  try
  {
    for (int step = 0; step < 3; ++step)
    {
      const double before = model.Energy();
      checkpoint.resize(model.CheckpointSize());
      model.Save(checkpoint.data());
      const StepReport report = model.Advance(ProgressMonitor());
      Require(mesh.NumberOfVertices() == 0 || std::isfinite(report.Residual),
        "the residual of a step is not finite");
      promises.Energy = promises.Energy && report.Residual <= promises.Residual;
      CheckState(mesh, model, start, before, energy, promises);
    }
    const Values last = model.State();
    model.Restore(checkpoint.data());
    model.Advance(ProgressMonitor());
    Require(model.State() == last, "a restored state goes on differently");
    return mesh.NumberOfVertices() > 0;
  }
  catch (const NotConverged&)
  {
  }
  catch (const std::runtime_error& error)
  {
    const bool boundless = std::string(error.what()).find("without bounds") != std::string::npos;
    Require(boundless || !promises.Solution || HasFlatTriangles(mesh), error.what());
  }
  return false;
}

bool Any(const Flags& flags)
{
  return flags.size() > 0 && flags.any();
}

bool RunLinear(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data,
  const TangentVectors& frames, bool delaunay)
{
  const TriangleMesh& mesh = assembler->Mesh();
  using Scheme = LinearDiffusion::Scheme;
  LinearDiffusion::Settings settings;
  settings.TimeStep = bytes.Size(8.0);
  settings.Fidelity = bytes.Flip() ? bytes.Size(6.0) : 0.0;
  settings.TimeScheme = static_cast<Scheme>(bytes.Below(3));
  CornerWeights coefficients = CotanWeights(mesh);
  const bool directed = bytes.Flip();
  const double across = bytes.Flip(4) ? 0.0 : bytes.Size(3.0);
  if (directed)
  {
    coefficients = AnisotropicWeights(mesh, coefficients, frames, bytes.Size(3.0), across);
  }
  Promises promises;
  // If one of the diffusivities is 0, there are many steady states.
  promises.Solution = !(directed && across == 0.0 && settings.TimeScheme == Scheme::SteadyState);
  promises.Sum = settings.Fidelity == 0.0 && !Any(data.Fixed);
  // On flat triangles the remaining error of a solver may be large, and have much energy.
  const bool isFlat = HasFlatTriangles(mesh);
  promises.Bounds = delaunay && !directed && settings.TimeScheme == Scheme::BackwardEuler &&
    settings.Fidelity == 0.0 && !isFlat;
  promises.Energy = settings.TimeScheme == Scheme::BackwardEuler && !Any(data.Fixed) && !isFlat;
  promises.Fidelity = settings.Fidelity;
  std::shared_ptr<LinearSolver> solver = ReadSolver(bytes);
  ReadFidelityFactors(bytes, data);
  LinearDiffusion model(assembler, coefficients, std::move(data), settings, std::move(solver));
  return Run(mesh, model, promises);
}

/// Some values at vertices and in triangles.
ScatteredValues ReadScatteredValues(Bytes& bytes, const TriangleMesh& mesh, const PointData& data)
{
  const int oneIn = 1 + bytes.Below(4);
  Flags known(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    known[i] = data.Given.row(i).allFinite() && (oneIn == 1 || bytes.Flip(oneIn));
  }
  ScatteredValues values = ScatteredValues::AtVertices(data.Given, known);
  const int inside = mesh.NumberOfTriangles() > 0 ? bytes.Below(4) : 0;
  for (int i = 0; i < inside; ++i)
  {
    const Index t = bytes.Below(mesh.NumberOfTriangles());
    SurfacePoint place;
    const int second = bytes.Below(5);
    const int third = bytes.Below(5 - second);
    place.Coordinates = { 1.0 - 0.25 * (second + third), 0.25 * second, 0.25 * third };
    for (std::size_t a = 0; a < 3; ++a)
    {
      place.Vertices[a] = mesh.TriangleVertices()(t, static_cast<Eigen::Index>(a));
    }
    if (data.Given.row(place.Vertices[0]).allFinite())
    {
      values.Places.push_back(place);
      values.Given.conservativeResize(values.Count(), data.Given.cols());
      values.Given.row(values.Count() - 1) = data.Given.row(place.Vertices[0]);
    }
  }
  values.Weights = Vector::Ones(values.Count());
  for (Index i = 0; i < values.Count(); ++i)
  {
    values.Weights[i] = bytes.Flip(4) ? bytes.Size(3.0) : 1.0;
  }
  return values;
}

/// Functions through values at a few points, which are NaN in components without a value.
bool RunInterpolation(
  Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, const PointData& data)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const ScatteredValues values = ReadScatteredValues(bytes, mesh, data);
  SmoothInterpolation::Settings settings;
  settings.Smoothing = static_cast<SmoothInterpolation::Choice>(bytes.Below(4));
  settings.Mu = bytes.Size(6.0);
  settings.NoiseLevel = bytes.Size(3.0);
  settings.Kappa = bytes.Flip() ? bytes.Size(2.0) : 0.0;
  settings.Rim = bytes.Flip(4) ? RimCondition::Free : RimCondition::Natural;
  settings.KeepRange = bytes.Flip(4);
  settings.ComputeError = bytes.Flip();
  settings.ComputeLeverage = bytes.Flip(4);
  if (values.Count() == 0)
  {
    return true;
  }
  InterpolationModel model(
    assembler, CotanWeights(mesh), values, settings, SerialFor(), bytes.Flip(4));
  std::vector<double> start(model.CheckpointSize());
  model.Save(start.data());
  try
  {
    model.Advance(ProgressMonitor());
    const Values u = model.State();
    const SmoothInterpolation::Result found = model.Found();
    for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
    {
      const Index begin = mesh.ComponentsBegin()[c];
      const Index size = mesh.ComponentsBegin()[c + 1] - begin;
      const bool isKnown = std::any_of(values.Places.begin(), values.Places.end(),
        [&](const SurfacePoint& place)
        { return place.Vertices[0] >= begin && place.Vertices[0] < begin + size; });
      for (const Values* array : { &u, &found.Error })
      {
        const auto part =
          array->middleRows(array->rows() > 0 ? begin : 0, array->rows() > 0 ? size : 0);
        for (Eigen::Index k = 0; k < part.cols(); ++k)
        {
          const bool isError = array == &found.Error;
          const bool mayBeNaN = !isKnown || (isError && found.HasUnknownError);
          const bool mayBeInfinite = isError && found.HasInfiniteError;
          const auto isOpen = part.col(k).array().isInf();
          const bool isFinite = (isOpen || part.col(k).array().isFinite()).all();
          const bool isNaN = (isOpen || part.col(k).array().isNaN()).all();
          Require(
            ((isKnown && isFinite) || (mayBeNaN && isNaN)) && (mayBeInfinite || !isOpen.any()),
            "an interpolation is not finite, or known without a value");
        }
      }
    }
    for (Eigen::Index k = 0; k < u.cols() && settings.KeepRange; ++k)
    {
      const double low = values.Given.col(k).minCoeff();
      const double high = values.Given.col(k).maxCoeff();
      Require(!(u.col(k).array() < low || u.col(k).array() > high).any(), "a range is not kept");
    }
    model.Restore(start.data());
    model.Advance(ProgressMonitor());
    Require((u.array() == model.State().array() || u.array().isNaN()).all(),
      "a restored interpolation differs");
    return true;
  }
  catch (const std::runtime_error& error)
  {
    // The operator squares cotangents, up to 1e4, and divides by areas.
    const double cotangent = std::min(1e4, CotanWeights(mesh).cwiseAbs().maxCoeff());
    const bool isResolved = cotangent * cotangent < 1e12 * mesh.ControlAreas().minCoeff();
    Require(!isResolved || HasFlatTriangles(mesh), error.what());
  }
  return false;
}

/// Whether the diffusivities along and across every gradient, whose ratio is 1 + b^2 |grad u|^2,
/// differ by less than round-off: a matrix keeps both then.
bool IsResolved(const TriangleMesh& mesh, const Values& u, double colorScale)
{
  constexpr double steepest = 1e8;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const GradientTensor gradients = SumGradients(mesh, u, t);
    if (gradients.ValueScale != 1.0 || !(colorScale * std::sqrt(gradients.T.Trace()) < steepest))
    {
      return false;
    }
  }
  return true;
}

/// Models whose diffusion tensor follows from the data.
bool RunTensor(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data,
  const TangentVectors& frames)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const int kind = bytes.Below(3);
  const double timeStep = bytes.Size(6.0);
  const double fidelity = bytes.Flip() ? bytes.Size(4.0) : 0.0;
  const double along = bytes.Flip() ? bytes.Size(2.0) : 1.0;
  const double scale = bytes.Size(6.0);
  Promises promises;
  promises.Sum = fidelity == 0.0 && !Any(data.Fixed);
  if (kind == 0)
  {
    BeltramiFlow::Settings settings;
    settings.TimeStep = timeStep;
    settings.Fidelity = fidelity;
    settings.AlongDiffusivity = along;
    settings.ColorScale = scale;
    settings.MassMetric =
      bytes.Flip() ? BeltramiFlow::Metric::Fixed : BeltramiFlow::Metric::Induced;
    promises.Sum = promises.Sum && settings.MassMetric == BeltramiFlow::Metric::Fixed;
    promises.Fidelity = fidelity;
    BeltramiFlow model(assembler, frames, std::move(data), settings, ReadSolver(bytes));
    promises.Solution = IsResolved(mesh, model.State(), scale);
    promises.Energy = promises.Solution && !HasFlatTriangles(mesh);
    promises.Residual = AnswerFactor * SolverTolerance;
    return Run(mesh, model, promises);
  }
  StructureDiffusion::Settings settings;
  settings.TimeStep = timeStep;
  settings.Fidelity = fidelity;
  settings.AlongDiffusivity = along;
  settings.Contrast = scale;
  settings.Model = kind == 1 ? StructureDiffusion::Kind::CoherenceEnhancing
                             : StructureDiffusion::Kind::EdgeEnhancing;
  auto integration = kind == 1 ? std::make_unique<TensorSmoothing>(
                                   std::make_shared<LineFieldOperator>(assembler->SharedMesh()),
                                   bytes.Size(2.0), 2, MakeCholeskySolver())
                               : nullptr;
  auto structure = std::make_unique<StructureTensor>(assembler->SharedMesh(),
    std::make_unique<HeatBlur>(assembler, bytes.Size(2.0), 2, MakeCholeskySolver()),
    std::move(integration));
  StructureDiffusion model(
    assembler, frames, std::move(data), settings, std::move(structure), ReadSolver(bytes));
  return Run(mesh, model, promises);
}

bool RunNonlinear(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data,
  const TangentVectors& frames)
{
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = bytes.Size(6.0);
  settings.Fidelity = bytes.Flip() ? bytes.Size(4.0) : 0.0;
  settings.Along = ReadEdgeFunction(bytes);
  settings.Across = bytes.Flip() ? ReadEdgeFunction(bytes) : settings.Along;
  settings.AlongDiffusivity = bytes.Size(2.0);
  settings.AcrossDiffusivity = bytes.Flip() ? bytes.Size(2.0) : settings.AlongDiffusivity;
  settings.Coupling = bytes.Flip() ? ChannelCoupling::Joint : ChannelCoupling::PerChannel;
  settings.Norm = bytes.Flip() ? FidelityNorm::L1 : FidelityNorm::L2;
  Promises promises;
  promises.Sum = settings.Fidelity == 0.0 && !Any(data.Fixed);
  const TriangleMesh& mesh = assembler->Mesh();
  if (bytes.Flip(3))
  {
    return RunTensor(bytes, assembler, std::move(data), frames);
  }
  if (bytes.Flip(3))
  {
    const auto edges = std::make_shared<const MedialMesh>(mesh);
    const auto operators = std::make_shared<const Assembler>(edges->Edges());
    if (HasFlatTriangles(mesh))
    {
      return false; // its start solves another system
    }
    TotalCorrection conserved(mesh, data, settings.Fidelity > 0.0);
    CrouzeixRaviartModel model(assembler, edges, std::move(data), std::move(conserved),
      [&](PointData ofEdges)
      {
        settings.Across = settings.Along;
        settings.AcrossDiffusivity = settings.AlongDiffusivity;
        return std::make_unique<NonlinearDiffusion>(
          operators, TangentVectors(0, 2), std::move(ofEdges), settings, ReadSolver(bytes));
      });
    return Run(mesh, model, promises);
  }
  NonlinearDiffusion model(assembler, frames, std::move(data), settings, ReadSolver(bytes));
  return Run(mesh, model, promises);
}

bool RunDeblurring(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double width = bytes.Size(2.0);
  const int steps = 2 + bytes.Below(4);
  // Conjugate gradients may fail on flat triangles, in the energy of the start already.
  auto blur = std::make_unique<HeatBlur>(assembler, width, steps, MakeCholeskySolver());
  const double fidelity = bytes.Size(4.0);
  Promises promises;
  promises.Energy = !HasFlatTriangles(mesh);
  promises.Solution = false; // products with the blur may be inexact
  promises.RoundOff = 1e-10; // on bad meshes, the blur of a constant is as inexact as its systems
  promises.Fidelity = fidelity;
  if (bytes.Flip())
  {
    TikhonovDeblurring model(assembler, CotanWeights(mesh), std::move(data), fidelity,
      std::move(blur), ReadSolver(bytes), { 1e-10, 1000 });
    return Run(mesh, model, promises);
  }
  promises.Variation = true;
  TotalVariationDeblurring::Settings settings;
  settings.Fidelity = fidelity;
  settings.Regularization.Coupling =
    bytes.Flip() ? ChannelCoupling::Joint : ChannelCoupling::PerChannel;
  settings.MaximumNumberOfIterations = 20;
  TotalVariationDeblurring model(
    assembler, TangentVectors(0, 2), std::move(data), settings, std::move(blur));
  return Run(mesh, model, promises);
}

/// Every row of u is a probability, and seeds keep their labels.
void CheckProbabilities(const Values& u, const std::vector<Index>& seeds)
{
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    Require(u.row(i).minCoeff() >= 0.0, "a probability is negative");
    Require(std::abs(u.row(i).sum() - 1.0) < 1e-9, "probabilities do not have the sum 1");
    const Index seed = seeds.empty() ? 0 : seeds[static_cast<std::size_t>(i)];
    Require(seed == 0 || u(i, seed - 1) == 1.0, "a seed has changed");
  }
}

/// The values are data of K means, or K given data terms if there are at least two columns.
bool RunSegmentation(
  Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const Eigen::Index channels = data.Given.cols();
  const bool hasMeans = channels < 2 || bytes.Flip();
  const Eigen::Index regions = hasMeans ? 2 + bytes.Below(4) : channels;
  Segmentation::Settings settings;
  settings.Fidelity = bytes.Flip(4) ? 0.0 : bytes.Size(4.0);
  settings.UpdateMeans = hasMeans && bytes.Flip();
  settings.UseSimplex = bytes.Flip();
  settings.MaximumNumberOfIterations = 200; // may end far from the minimum
  settings.MaximumNumberOfAlternations = 5;
  Segmentation::Input input;
  input.Means.resize(hasMeans ? regions : 0, channels);
  for (Eigen::Index k = 0; k < input.Means.rows(); ++k)
  {
    for (Eigen::Index c = 0; c < channels; ++c)
    {
      input.Means(k, c) = bytes.Short();
    }
  }
  if (bytes.Flip())
  {
    input.Seeds.resize(static_cast<std::size_t>(mesh.NumberOfVertices()));
    for (Index& seed : input.Seeds)
    {
      seed = bytes.Flip(4) ? 1 + bytes.Below(static_cast<int>(regions)) : 0;
    }
  }
  input.Data = std::move(data);
  const std::vector<Index> seeds = input.Seeds;
  Segmentation model(assembler, std::move(input), settings);
  const bool hasResult = Run(mesh, model, Promises());
  CheckProbabilities(model.State(), seeds);
  return hasResult;
}

bool RunMinimizing(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data,
  const TangentVectors& frames)
{
  TotalVariationFlow::Settings settings;
  settings.SteadyState = bytes.Flip();
  settings.TimeStep = bytes.Size(5.0);
  settings.Fidelity = bytes.Flip() ? bytes.Size(4.0) : 0.0;
  settings.Function.Beta = 0.0;
  settings.Function.Threshold = bytes.Size(2.0);
  settings.Function.Kind = std::array<EdgeFunctionKind, 3>{ EdgeFunctionKind::TotalVariation,
    EdgeFunctionKind::Charbonnier, EdgeFunctionKind::Constant }[bytes.Below(3)];
  settings.AlongDiffusivity = bytes.Size(1.0);
  settings.AcrossDiffusivity = bytes.Flip() ? bytes.Size(1.0) : settings.AlongDiffusivity;
  settings.Coupling = bytes.Flip() ? ChannelCoupling::Joint : ChannelCoupling::PerChannel;
  settings.Norm = bytes.Flip() ? FidelityNorm::L1 : FidelityNorm::L2;
  settings.MaximumNumberOfIterations = 200; // may end far from the minimum
  Promises promises;
  // The minimisation can then pass through values so large that the sum is lost in round-off.
  promises.Sum =
    settings.Fidelity == 0.0 && !Any(data.Fixed) && !HasFlatTriangles(assembler->Mesh());
  ReadFidelityFactors(bytes, data);
  if (bytes.Flip(4))
  {
    return RunDeblurring(bytes, assembler, std::move(data));
  }
  if (bytes.Flip(4))
  {
    return RunSegmentation(bytes, assembler, std::move(data));
  }
  TotalVariationFlow model(assembler, frames, std::move(data), settings);
  return Run(assembler->Mesh(), model, promises);
}

bool RunMumfordShah(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data)
{
  MumfordShah::Settings settings;
  settings.Fidelity = bytes.Flip() ? bytes.Size(4.0) : 0.0;
  settings.EdgeCost = bytes.Size(4.0);
  settings.EdgeWidth = bytes.Size(2.0);
  settings.StopTolerance = 0.01;
  const TriangleMesh& mesh = assembler->Mesh();
  Promises promises;
  promises.Sum = settings.Fidelity == 0.0 && !Any(data.Fixed) && !HasFlatTriangles(mesh);
  MumfordShah model(
    assembler, CotanWeights(mesh), std::move(data), settings, ReadSolver(bytes), ReadSolver(bytes));
  return Run(mesh, model, promises);
}

bool RunHarmonic(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler, PointData data)
{
  const TriangleMesh& mesh = assembler->Mesh();
  HarmonicMap::Settings settings;
  settings.TimeStep = bytes.Size(6.0);
  settings.Exponent = 1.0 + bytes.Below(5) / 4.0;
  settings.Beta = bytes.Size(8.0);
  settings.Fidelity = bytes.Flip() ? bytes.Size(4.0) : 0.0;
  settings.TimeScheme = static_cast<HarmonicMap::Scheme>(bytes.Below(3));
  settings.ConsistentReaction = bytes.Flip();
  settings.LineField = bytes.Flip(3);
  settings.Limits = { 1e-8, 200 };
  if (data.Given.cols() < 2)
  {
    data.Given = data.Given.replicate(1, 2).eval();
  }
  FillMissingUnitVectors(
    mesh, data, settings.LineField, static_cast<InitialFill>(bytes.Below(3)), 1, Ids(mesh));
  const bool paper = settings.TimeScheme == HarmonicMap::Scheme::ExplicitReaction;
  Promises promises;
  promises.Length = true;
  promises.Energy = !paper;
  HarmonicMap model(assembler, CotanWeights(mesh), std::move(data), settings,
    paper ? ReadSolver(bytes) : MakeCholeskySolver());
  return Run(mesh, model, promises);
}

bool RunReaction(Bytes& bytes, const std::shared_ptr<const Assembler>& assembler)
{
  const TriangleMesh& mesh = assembler->Mesh();
  Reaction reaction;
  reaction.Terms = &GetKinetics(static_cast<KineticsName>(bytes.Below(NumberOfKinetics)));
  reaction.Parameters = reaction.Terms->Defaults();
  reaction.Rate = bytes.Size(2.0);
  ReactionDiffusion::Settings settings;
  settings.TimeStep = bytes.Size(3.0) / 16.0;
  settings.TimeScheme =
    bytes.Flip() ? ReactionDiffusion::Scheme::FirstOrder : ReactionDiffusion::Scheme::SecondOrder;
  settings.KeepNonNegative = reaction.Terms->NonNegative && bytes.Flip();
  settings.StopTolerance = bytes.Flip(4) ? bytes.Size(4.0) : 0.0;
  PointData data =
    PointData::FromValues(NoisySteadyState(reaction, std::abs(bytes.Short()), 1, Ids(mesh)));
  std::array<ReactionDiffusion::Chemical, 2> chemicals;
  for (auto& chemical : chemicals)
  {
    chemical.Coefficients = bytes.Size(4.0) * CotanWeights(mesh);
    chemical.Solver = ReadSolver(bytes);
  }
  ReactionDiffusion model(assembler, reaction, chemicals, std::move(data), settings);
  return Run(mesh, model, Promises());
}

} // namespace

Outcome RunFromBytes(const std::uint8_t* begin, std::size_t count)
{
  Bytes bytes(begin, count);
  const int model = bytes.Below(NumberOfModels);
  const Points points = ReadPoints(bytes);
  const Triangles triangles = ReadTriangles(bytes, static_cast<int>(points.rows()));
  const auto original = std::make_shared<TriangleMesh>(points, triangles);
  Points vectors(points.rows(), 3);
  for (Eigen::Index i = 0; i < vectors.rows(); ++i)
  {
    vectors.row(i) << bytes.Short(), bytes.Short(), bytes.Short();
  }
  TangentVectors frames = TangentVectorsFromPointVectors(*original, points, triangles, vectors);
  if (model == 5)
  {
    RunGeometry(bytes, Assembler(original), points, triangles, frames);
    return { model, original->NumberOfVertices() > 0 };
  }
  const bool delaunay = bytes.Flip();
  std::shared_ptr<const TriangleMesh> mesh = original;
  if (delaunay)
  {
    const IntrinsicDelaunay triangulation(original);
    frames = triangulation.Transport(frames);
    mesh = triangulation.Mesh();
  }
  const auto assembler = std::make_shared<const Assembler>(mesh);
  if (model == 4)
  {
    return { model, RunReaction(bytes, assembler) };
  }
  // The minimiser's accuracy is relative to the change that a step can make.
  PointData data = ReadData(bytes, *mesh, model == 2 ? 3.0 : 90.0);
  if (model == 3)
  {
    return { model, RunHarmonic(bytes, assembler, std::move(data)) };
  }
  FillMissing(*mesh, data, static_cast<InitialFill>(bytes.Below(3)), 1, Ids(*mesh));
  switch (model)
  {
    case 0:
    {
      const bool hasResult = RunLinear(bytes, assembler, data, frames, delaunay);
      // Read last, so that the bytes of earlier findings keep their meaning.
      const bool isFitted = !bytes.Flip() || RunInterpolation(bytes, assembler, data);
      return { model, hasResult && isFitted };
    }
    case 1:
      return { model, RunNonlinear(bytes, assembler, std::move(data), frames) };
    case 6:
      return { model, RunMumfordShah(bytes, assembler, std::move(data)) };
    default:
      return { model, RunMinimizing(bytes, assembler, std::move(data), frames) };
  }
}

} // namespace SurfaceDiffusion::Testing
