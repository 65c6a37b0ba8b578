// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/HarmonicMapSettings.h"

#include "Core/Models/Harmonic/UnitVectors.h"
#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"
#include "Run/VectorSettings.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The length scale of MoveVertices, in mean edge lengths: noise is shorter, features are longer.
/// Measured on noisy spheres and on fandisk.
constexpr double UpdateRange = 5.0;

/// Whether vectors may be tangent to the surface: eight tenths of them lie within 30 degrees of a triangle
/// at their vertex, of a thousand vertices. It costs little, unlike the tangent planes.
bool MayBeTangent(const TriangleMesh& mesh, const Points& positions, const PointData& data)
{
  const Index stride = std::max<Index>(1, mesh.NumberOfVertices() / 1000);
  Index known = 0;
  Index near = 0;
  for (Index i = 0; i < mesh.NumberOfVertices(); i += stride)
  {
    const Index corner = mesh.VertexCorners()[mesh.VertexCornersBegin()[i]];
    const Eigen::RowVector3d a = positions.row(mesh.OtherCorner(corner, 1)) - positions.row(i);
    const Eigen::RowVector3d b = positions.row(mesh.OtherCorner(corner, 2)) - positions.row(i);
    const Eigen::RowVector3d u = data.Given.row(i);
    const double length = u.norm();
    if (!data.Missing[i] && length > 0.0)
    {
      ++known;
      near += std::abs(u.dot(a.cross(b).stableNormalized())) <= 0.5 * length ? 1 : 0;
    }
  }
  return 10.0 * near >= 8.0 * known && known > 0;
}

} // namespace

void HarmonicMapSettings::Visit(SettingVisitor& visitor)
{
  this->DataSettings::Visit(visitor);
  VisitTimeIntegrator(visitor, this->TimeIntegrator, { true, false, false, false, false });
  visitor.Number({ "Exponent", "",
                   "p, from 1 to 2. 1: equation (21), preserves creases. 2: equation (20), "
                   "smooths evenly." },
    this->Exponent, SettingRange::Between(1.0, 2.0, "numbers from 1 to 2"));
  visitor.Number({ "Beta", "1/h^2",
                   "The regularisation beta in |grad u|^2 + beta, above 0, in 1/length^2 "
                   "(natural units: 1/h^2). Gradients below its square root are smoothed as with "
                   "Exponent 2.",
                   "Exponent!=2" },
    this->Beta, SettingRange::NonNegative());
  visitor.Choice({ "Scheme", "",
                   "The scheme of a time step. TangentPlane: one linear solve for displacements "
                   "tangential to the sphere; the energy never increases. MinimizingMovement: "
                   "the same repeated until the nonlinear step is solved; it takes longer, "
                   "depends less on TimeStep, and the energy never increases. ExplicitReaction: "
                   "the scheme of the paper." },
    this->Scheme, { "ExplicitReaction", "TangentPlane", "MinimizingMovement" });
  visitor.Switch({ "ConsistentReaction", "",
                   "Use the reaction term u g |grad u|^2, which balances the diffusion, instead "
                   "of the paper's u |grad u|^p.",
                   "Scheme=ExplicitReaction" },
    this->ConsistentReaction);
  visitor.Switch(
    { "ProjectToSphere", "", "Normalise the vectors after each step. Off: their lengths drift." },
    this->ProjectToSphere);
  visitor.Switch({ "LineField", "",
                   "Treat u and -u as equal, as for principal directions. The sign of the result "
                   "has no meaning." },
    this->LineField);
  visitor.Choice(
    { "TangentTo", "",
      "What the vectors are tangent to. None: nothing, any unit vector is allowed. Surface: "
      "three components, whose part in the tangent plane of the surface is normalised, and "
      "stays in that plane. For directions along the surface, such as fibres." },
    this->TangentTo, { "None", "Surface" });
  visitor.Switch(
    { "MoveVertices", "",
      "Move the points so that the triangles turn as the normals have turned: mesh denoising.",
      SettingScope::Output },
    this->MoveVertices);
}

void HarmonicMapSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->DataSettings::CheckTogether(fields, problems);
  Require(this->Exponent == 2.0 || this->Beta != 0.0, Word::Setting("Beta"), this->Beta,
    "finite numbers above 0", problems);
  const bool isTangent = this->TangentTo == SurfaceDiffusion::TangentTo::Surface;
  const Sentence purpose = Sentence(Word::Setting("TangentTo"))
    << " " << Word::Choice("TangentTo", this->TangentTo, "Surface");
  Require(!isTangent || !this->MoveVertices, Word::Setting("MoveVertices"),
    Word::SwitchNumber(true), Sentence(Word::SwitchNumber(false)) << " together with " << purpose,
    problems);
  if (fields && fields->Data)
  {
    const int columns = fields->DataComponents;
    Sentence found = fields->DataName;
    found << " has " << columns << " components; allowed: ";
    if (this->MoveVertices && columns != 3)
    {
      problems.push_back(found << "3 with " << Word::Setting("MoveVertices"));
    }
    else if (isTangent && columns != 3)
    {
      problems.push_back(found << "3 with " << purpose);
    }
    else if (columns < 2)
    {
      problems.push_back(found << "2 or more, alpha of colours not counted");
    }
  }
}

ModelTraits HarmonicMapSettings::DescribeModel() const
{
  ModelTraits traits = this->DescribeSteps();
  traits.Time = { this->Exponent, 0.0 };
  traits.Energy = { 2.0 - this->Exponent, 0.0 };
  traits.HasValueRange = false;
  traits.ResultSuffix = "Harmonic";
  traits.UsesFidelity = this->FidelityWeight > 0.0;
  traits.StateIsUnitVectors = true;
  traits.StateIsLines = this->LineField;
  const bool isTangent = this->TangentTo == SurfaceDiffusion::TangentTo::Surface;
  traits.Vectors = isTangent ? VectorType::Tangent : VectorType::Components;
  traits.CanBeDistributed = !this->MoveVertices && !isTangent;
  DescribeData(*this, traits);
  return traits;
}

SolverTask HarmonicMapSettings::MakeTask(const ModelInputs& inputs, double timeStep) const
{
  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.DiffusionNumber =
    this->LargestDiffusivity() * timeStep / std::pow(inputs.Units.CoreEdgeLength(), this->Exponent);
  task.IsPreconditioner = this->Scheme != HarmonicMap::Scheme::ExplicitReaction;
  return task;
}

/// The normals of the surface if the vectors are tangent to it, whose data become so. If they are by
/// themselves, and nothing keeps them there, the result says so.
Values HarmonicMapSettings::PrepareTangents(ModelInputs& inputs, RunResult& result) const
{
  const bool isTangent = this->TangentTo == SurfaceDiffusion::TangentTo::Surface;
  Values normals;
  if (inputs.Data.Given.cols() != 3)
  {
    return normals;
  }
  Points positions = VertexPositions(inputs.Surface);
  if (!isTangent &&
    !inputs.Processes.Any(MayBeTangent(inputs.Surface.Mesh(), positions, inputs.Data)))
  {
    return normals;
  }
  const TangentPlanes planes(inputs.Surface.SharedMesh(), std::move(positions), inputs.Parallel);
  normals.resize(inputs.Data.Given.rows(), 3);
  for (Index i = 0; i < static_cast<Index>(normals.rows()); ++i)
  {
    normals.row(i) = planes.Normal(i);
  }
  const TangentShare share = MeasureTangents(planes, inputs.Data, inputs.Processes);
  Sentence text(Word::Array("InputArray"));
  if (isTangent)
  {
    if (share.AreNormal())
    {
      result.WarnOnce(text << " has the normals of the surface, which have no direction in its "
                              "tangent plane (choose directions along the surface, or set "
                           << Word::Setting("TangentTo") << " to "
                           << Word::Choice("TangentTo", SurfaceDiffusion::TangentTo::None, "None")
                           << ")");
    }
    ProjectIntoPlanes(normals, inputs.Data.Given);
    ProjectIntoPlanes(normals, inputs.Data.Start);
    for (Index i = 0; i < static_cast<Index>(normals.rows()); ++i)
    {
      // Nothing is held where a vector along the normal is missing.
      inputs.Data.Fixed[i] = inputs.Data.Fixed[i] && !inputs.Data.Given.row(i).isZero(0.0);
    }
    return normals;
  }
  if (share.AreTangent())
  {
    result.WarnOnce(
      text << " has vectors that lie in the surface, and may leave it (to keep them "
              "there, set "
           << Word::Setting("TangentTo") << " to "
           << Word::Choice("TangentTo", SurfaceDiffusion::TangentTo::Surface, "Surface") << ")");
  }
  return Values();
}

std::unique_ptr<Model> HarmonicMapSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  Values normals = this->PrepareTangents(inputs, result);
  FillMissingUnitVectors(inputs.Surface.Mesh(), inputs.Data, this->LineField, this->InitialFill,
    this->RandomSeed, inputs.Ids);
  if (this->InitialFill == SurfaceDiffusion::InitialFill::Harmonic && !this->LineField)
  {
    const Values means = inputs.Data.Start;
    FillHarmonicallyIf(true, inputs, result);
    NormalizeFilled(inputs.Data, means);
  }
  if (normals.rows() > 0)
  {
    NormalizeFilledInPlanes(normals, inputs.Data);
  }
  if (inputs.Processes.Any((inputs.Data.Fixed && inputs.Data.Missing).any()))
  {
    throw InputError(Sentence(Word::Array("InputArray"))
      << " has a vector of length zero where " << Word::Array("FixedArray")
      << " holds it; allowed there: vectors with a direction");
  }
  CompletePreparation(*this, inputs, result);
  result.AddNumber("EffectiveFidelityWeight", this->FidelityWeight);

  const double p = this->Exponent;
  const double fastest = this->LargestDiffusivity();
  HarmonicMap::Settings settings;
  settings.Exponent = p;
  settings.TimeStep = inputs.Units.ToCore(this->TimeStep, p, 0.0);
  settings.Beta = inputs.Units.ToCore(this->Beta, -2.0, 0.0);
  settings.Fidelity = inputs.Units.ToCore(this->FidelityWeight, -p, 0.0);
  settings.TimeScheme = this->Scheme;
  settings.MaximumNumberOfRepetitions = this->MaximumNumberOfRepetitions;
  settings.ConsistentReaction = this->ConsistentReaction;
  settings.ProjectToSphere = this->ProjectToSphere;
  settings.LineField = this->LineField;
  settings.Normals = std::move(normals);
  settings.LargestDiffusivity = fastest > 0.0 ? fastest : 1.0;
  settings.Limits.Tolerance = this->Tolerance;
  settings.Limits.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  if (this->Solver == SolverMethod::Direct || this->Solver == SolverMethod::Multigrid)
  {
    settings.Method = HarmonicMap::Preconditioner::Factor;
  }
  else if (this->Solver == SolverMethod::ConjugateGradient)
  {
    settings.Method = HarmonicMap::Preconditioner::Jacobi;
  }
  const double solvesPerStep = p == 2.0 ? 1.0 : 0.0; // with other exponents each step has a matrix
  const auto solver = inputs.Solvers.Find(
    SolverPurpose::Step, this->MakeTask(inputs, settings.TimeStep), solvesPerStep);
  return std::make_unique<HarmonicMap>(inputs.Surface.SharedAssembler(), MakeWeights(*this, inputs),
    std::move(inputs.Data), settings, solver, inputs.Parallel);
}

std::vector<Output> HarmonicMapSettings::Finish(const RunState& state, RunResult& result) const
{
  std::vector<Output> outputs = this->DataSettings::Finish(state, result);
  outputs.front().Active = Role::Vectors;
  VertexMotion motion;
  if (this->MoveVertices)
  {
    outputs.push_back({ "Points", Place::PerPoint, OutputType::Double,
      this->MovePoints(state, motion), Role::Coordinates });
  }
  result.MissedResidual = motion.MissedResidual;
  const double change =
    motion.VolumeBefore != 0.0 ? motion.VolumeAfter / motion.VolumeBefore - 1.0 : 0.0;
  if (std::abs(change) > LargestVolumeChange)
  {
    Sentence text(Word::Setting("MoveVertices"));
    result.WarnOnce(text << " changes the volume by " << 100.0 * change
                         << " %: shape was smoothed, too (for less, set "
                         << Word::Setting("NumberOfTimeSteps") << " or "
                         << Word::Setting("TimeStep") << " lower)");
  }
  const TriangleMesh& mesh = state.Surface.InputMesh();
  outputs.push_back(
    Output::OfNumber("MeanDisplacement", motion.MeanDisplacement, Combination::Mean));
  outputs.back().Weight = mesh.ControlAreas().sum() * mesh.LengthUnit() * mesh.LengthUnit();
  outputs.push_back(
    Output::OfNumber("MaximumDisplacement", motion.MaximumDisplacement, Combination::Largest));
  outputs.push_back(Output::OfNumber("VolumeBefore", motion.VolumeBefore, Combination::Sum));
  outputs.push_back(Output::OfNumber("VolumeAfter", motion.VolumeAfter, Combination::Sum));
  return outputs;
}

/// The points of the input, moved as the vectors have turned.
Points HarmonicMapSettings::MovePoints(const RunState& state, VertexMotion& motion) const
{
  const Surface& surface = state.Surface;
  const TriangleMesh& mesh = surface.InputMesh();
  const IterationLimits limits = WithoutInertia(this->DescribeModel().Limits);
  const Points moved =
    UpdateVerticesFromNormals(mesh, surface.Points(), *state.Path.CurrentModel().GivenData(),
      state.Path.State(), UpdateRange * state.Units.MeanEdgeLength, motion, limits,
      this->Solver != SolverMethod::ConjugateGradient, state.Parallel, state.Progress);
  Points points = surface.Points();
  for (Eigen::Index i = 0; i < moved.rows(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v >= 0) // points merged into one vertex move together
    {
      const Index vertex = mesh.InputVertex()[static_cast<std::size_t>(v)];
      points.row(i) += moved.row(vertex) - surface.Points().row(vertex);
    }
  }
  return points;
}

} // namespace SurfaceDiffusion
