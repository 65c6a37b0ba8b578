// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHarmonicMapFilter.h"

#include "Conversion/EnumText.h"
#include "Conversion/NewArray.h"
#include "Conversion/PointArrays.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SurfaceRun.h"
#include "Core/Geometry/VertexUpdating.h"
#include "Core/Models/HarmonicMap.h"
#include "Core/Models/UnitVectors.h"
#include "Core/Operators/CotanWeights.h"
#include "Distributed/SurfacePieces.h"

#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <vector>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkHarmonicMapFilter);

namespace
{

/// r of MoveVertices, in mean edge lengths: noise is shorter, the shape longer. Measured on noisy
/// spheres and on fandisk.
constexpr double FitRange = 5.0;

/// Coordinates beyond these make single precision or squares overflow.
constexpr double LargestExtent = 1e15;
constexpr double SmallestExtent = 1e-15;

/// The block, in coordinates whose squares a float can hold.
vtkSmartPointer<vtkPolyData> WithModerateCoordinates(vtkPolyData* block)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(block->GetPoints());
  result->SetPolys(block->GetPolys());
  result->SetStrips(block->GetStrips());
  const vtkBoundingBox box(result->GetBounds());
  const double extent = box.GetMaxLength();
  if (extent > 0.0 && (extent > LargestExtent || extent < SmallestExtent))
  {
    vtkNew<vtkPoints> points;
    points->SetData(NewArray<vtkDoubleArray>("Points", 3, block->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
    {
      double x[3];
      block->GetPoint(i, x);
      for (int k = 0; k < 3; ++k)
      {
        x[k] = x[k] / extent - box.GetBound(2 * k) / extent;
      }
      points->SetPoint(i, x);
    }
    result->SetPoints(points);
  }
  return result;
}

/// A copy in single precision where `type` is that, otherwise in double.
vtkSmartPointer<vtkPoints> ConvertPoints(vtkPoints* from, int type)
{
  const vtkIdType count = from->GetNumberOfPoints();
  auto points = vtkSmartPointer<vtkPoints>::New();
  if (type == VTK_FLOAT)
  {
    points->SetData(NewArray<vtkFloatArray>("Points", 3, count));
  }
  else
  {
    points->SetData(NewArray<vtkDoubleArray>("Points", 3, count));
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, from->GetPoint(i));
  }
  return points;
}

/// Adds the normals of the polygons to those of their points, one polygon after the other: sums in
/// the order of threads would differ from run to run, as those of vtkPolyDataNormals do.
class NormalSums
{
public:
  explicit NormalSums(vtkPolyData* block)
    : Coordinates(block->GetPoints())
    , Sums(3 * static_cast<std::size_t>(block->GetNumberOfPoints()), 0.0)
  {
    this->AddCells(block->GetPolys(), false);
    this->AddCells(block->GetStrips(), true);
  }

  std::vector<double>& Get() { return this->Sums; }

private:
  void AddCells(vtkCellArray* cells, bool strips)
  {
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    const vtkIdType points = this->Coordinates->GetNumberOfPoints();
    for (vtkIdType c = 0; c < count; ++c)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCellAtId(c, size, ids);
      if (size < 3 ||
        std::any_of(ids, ids + size, [&](vtkIdType id) { return id < 0 || id >= points; }))
      {
        continue; // an error, told later with others of its kind
      }
      if (!strips)
      {
        this->AddPolygon(size, ids);
      }
      for (vtkIdType i = 0; strips && i + 2 < size; ++i)
      {
        const vtkIdType corners[3] = { ids[i], ids[i + 1 + i % 2], ids[i + 2 - i % 2] };
        this->AddPolygon(3, corners);
      }
    }
  }

  void AddPolygon(vtkIdType size, const vtkIdType* ids)
  {
    double normal[3];
    vtkPolygon::ComputeNormal(this->Coordinates, static_cast<int>(size), ids, normal);
    for (vtkIdType i = 0; i < size; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        this->Sums[3 * ids[i] + k] += normal[k];
      }
    }
  }

  vtkPoints* Coordinates;
  std::vector<double> Sums;
};

/// One normal per point, the mean of those of its polygons; zero where there is none.
vtkSmartPointer<vtkDataArray> ComputeNormals(vtkPolyData* block)
{
  const vtkSmartPointer<vtkPolyData> surface = WithModerateCoordinates(block);
  NormalSums normals(surface);
  const auto array = NewArray<vtkFloatArray>("Normals", 3, block->GetNumberOfPoints());
  for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
  {
    double* normal = normals.Get().data() + 3 * i;
    vtkMath::Normalize(normal);
    array->SetTuple(i, normal);
  }
  return array;
}

/// Whether a tuple has no direction.
bool HasZeroOrNaN(vtkDataArray* vectors)
{
  std::vector<double> tuple(vectors->GetNumberOfComponents());
  for (vtkIdType i = 0; i < vectors->GetNumberOfTuples(); ++i)
  {
    vectors->GetTuple(i, tuple.data());
    double sum = 0.0;
    for (const double x : tuple)
    {
      sum += std::abs(x);
    }
    if (!(sum > 0.0))
    {
      return true;
    }
  }
  return false;
}

} // namespace

vtkHarmonicMapFilter::vtkHarmonicMapFilter()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
}

vtkHarmonicMapFilter::~vtkHarmonicMapFilter() = default;

const char* vtkHarmonicMapFilter::GetSchemeAsString()
{
  return EnumText(this->Scheme, { "ExplicitReaction", "TangentPlane", "MinimizingMovement" });
}

void vtkHarmonicMapFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetSchemeToExplicitReaction();
  this->SetConsistentReaction(false);
  this->SetProjectToSphere(true);
  this->SetLineField(false);
  this->SetMoveVertices(false);
}

void vtkHarmonicMapFilter::CheckProperties(Problems& problems)
{
  this->Superclass::CheckProperties(problems);
  Require(this->TimeIntegrator == TIME_INTEGRATOR_FIRST_ORDER, "TimeIntegrator",
    this->TimeIntegrator, "0 FirstOrder", problems);
  Require(this->Exponent >= 1.0 && this->Exponent <= 2.0, "Exponent", this->Exponent,
    "numbers from 1 to 2", problems);
  const bool betaMatters = this->Exponent != 2.0;
  Require(std::isfinite(this->Beta) && (betaMatters ? this->Beta > 0.0 : this->Beta >= 0.0), "Beta",
    this->Beta,
    betaMatters ? "finite numbers above 0" : "finite numbers, 0 or more with Exponent 2", problems);
  Require(this->Scheme >= SCHEME_EXPLICIT_REACTION && this->Scheme <= SCHEME_MINIMIZING_MOVEMENT,
    "Scheme", this->Scheme, "0 ExplicitReaction, 1 TangentPlane, 2 MinimizingMovement", problems);
}

//------------------------------------------------------------------------------------------------
int vtkHarmonicMapFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  for (auto& computed : this->Computed)
  {
    computed.second.Used = false;
  }
  this->MeanDisplacement = this->MaximumDisplacement = 0.0;
  this->VolumeBefore = this->VolumeAfter = 0.0;
  this->MovedArea = 0.0;
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  this->MovedPoints.clear();
  for (auto it = this->Computed.begin(); it != this->Computed.end();)
  {
    it = it->second.Used ? std::next(it) : this->Computed.erase(it);
  }
  return result;
}

vtkDataArray* vtkHarmonicMapFilter::FindNormals(vtkPolyData* block)
{
  if (vtkDataArray* active = block->GetPointData()->GetNormals())
  {
    return active;
  }
  ComputedNormals& computed =
    this->Computed[PolyDataSurface::Key(block, PolyDataSurface::Options())];
  if (!computed.Array)
  {
    computed.Array = ComputeNormals(block);
  }
  computed.Used = true;
  return computed.Array;
}

bool vtkHarmonicMapFilter::IsNormals(vtkDataArray* array, vtkPolyData* block) const
{
  return array == block->GetPointData()->GetNormals() ||
    std::any_of(this->Computed.begin(), this->Computed.end(),
      [&](const auto& computed) { return computed.second.Array == array; });
}

/// Whether no array is asked for by its name or as another attribute.
bool vtkHarmonicMapFilter::AsksForNormals()
{
  vtkInformation* asked = this->GetInputArrayInformation(0);
  const char* name =
    asked->Has(vtkDataObject::FIELD_NAME()) ? asked->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool byName = name && *name;
  const bool byOtherAttribute = !name && asked->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) &&
    asked->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) != vtkDataSetAttributes::NORMALS;
  return !byName && !byOtherAttribute;
}

bool vtkHarmonicMapFilter::FindArrays(vtkPolyData* block, BlockArrays& arrays, Problems& problems)
{
  // Where nothing else is asked for, the block is read as if it had normals in any case.
  vtkNew<vtkPolyData> withNormals;
  withNormals->ShallowCopy(block);
  if (this->AsksForNormals())
  {
    vtkDataArray* const normals = this->FindNormals(block);
    withNormals->GetPointData()->SetNormals(normals);
    withNormals->GetPointData()->SetScalars(normals); // what an empty name stands for
  }
  if (!this->Superclass::FindArrays(withNormals, arrays, problems))
  {
    return false;
  }
  const std::string label =
    std::string("InputArray \"") + (arrays.Data->GetName() ? arrays.Data->GetName() : "") + "\"";
  if (NumberOfDataComponents(arrays.Data) < 2)
  {
    problems.push_back(label + " has " + std::to_string(arrays.Data->GetNumberOfComponents()) +
      " components; allowed: 2 or more, alpha of colours not counted");
  }
  if (this->MoveVertices && !this->IsNormals(arrays.Data, block))
  {
    problems.push_back("MoveVertices is on but " + label +
      " is not the surface's normals; allowed: off, or the active normals or none as InputArray");
  }
  return true;
}

/// Not where vertices move, where normals are to be computed, and where lines are missing, whose
/// start depends on the order of their neighbours.
bool vtkHarmonicMapFilter::CanBeDistributed(const std::vector<SurfacePiece>& pieces)
{
  for (const SurfacePiece& piece : pieces)
  {
    vtkPolyData* const block = piece.Input;
    if (block->GetNumberOfPoints() == 0)
    {
      continue;
    }
    if (this->AsksForNormals() && !block->GetPointData()->GetNormals())
    {
      return false;
    }
    BlockArrays arrays;
    Problems told; // later
    if (this->LineField && this->FindArrays(block, arrays, told) &&
      ((arrays.Mask && this->MaskMode == MASK_MODE_INPAINT) || HasZeroOrNaN(arrays.Data)))
    {
      return false;
    }
  }
  return !this->MoveVertices;
}

//------------------------------------------------------------------------------------------------
void vtkHarmonicMapFilter::WriteRunKey(std::ostream& key)
{
  this->Superclass::WriteRunKey(key);
  key << this->Exponent << ' ' << this->Beta << ' ' << this->Scheme << ' '
      << this->ConsistentReaction << ' ' << this->ProjectToSphere << ' ' << this->LineField << ' ';
}

void vtkHarmonicMapFilter::PrepareData(ModelInput& input)
{
  FillMissingUnitVectors(*input.Surface.Mesh, input.Data, this->LineField,
    static_cast<SurfaceDiffusion::InitialFill>(this->InitialFill), this->RandomSeed, input.Ids);
  if (input.Surface.Mesh->GetReduction().Any((input.Data.Fixed && input.Data.Missing).any()))
  {
    throw std::runtime_error("InputArray has a vector of length zero where FixedArray holds it; "
                             "fixed vectors must have a direction");
  }
}

std::unique_ptr<SurfaceDiffusion::Model> vtkHarmonicMapFilter::MakeModel(
  ModelInput& input, int steps)
{
  const TriangleMesh& mesh = *input.Surface.Mesh;
  const CornerWeights isotropic = CotanWeights(mesh, input.Parallel);
  const bool directed = this->AlongDiffusivity != this->AcrossDiffusivity;
  CornerWeights coefficients = directed
    ? AnisotropicWeights(mesh, isotropic, input.Frames, this->AlongDiffusivity,
        this->AcrossDiffusivity, input.Parallel)
    : CornerWeights(this->AlongDiffusivity * isotropic);
  const double fastest = std::max(this->AlongDiffusivity, this->AcrossDiffusivity);

  const double p = this->Exponent;
  HarmonicMap::Settings settings;
  settings.Exponent = p;
  settings.TimeStep = input.Units.ToCore(this->TimeStep, p, 0.0);
  settings.Beta = input.Units.ToCore(this->Beta, -2.0, 0.0);
  settings.Fidelity = input.Units.ToCore(this->FidelityWeight, -p, 0.0);
  settings.TimeScheme = static_cast<HarmonicMap::Scheme>(this->Scheme);
  settings.ConsistentReaction = this->ConsistentReaction;
  settings.ProjectToSphere = this->ProjectToSphere;
  settings.LineField = this->LineField;
  settings.LargestDiffusivity = fastest > 0.0 ? fastest : 1.0;
  settings.Limits.Tolerance = this->Tolerance;
  settings.Limits.MaximumNumberOfIterations = this->MaximumNumberOfIterations;

  const double h = input.Units.MeanEdgeLength / input.Units.LengthUnit;
  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.DiffusionNumber = fastest * settings.TimeStep / std::pow(h, p);
  task.NumberOfSolves = p == 2.0 ? steps : 1.0;
  switch (this->Solver)
  {
    case SOLVER_DIRECT:
      settings.Method = HarmonicMap::Preconditioner::Factor;
      break;
    case SOLVER_CONJUGATE_GRADIENT:
      settings.Method = HarmonicMap::Preconditioner::Jacobi;
      break;
    case SOLVER_MULTIGRID:
      settings.Method = mesh.GetReduction().IsSerial() ? HarmonicMap::Preconditioner::Automatic
                                                       : HarmonicMap::Preconditioner::Factor;
      break;
    default:
      settings.Method = HarmonicMap::Preconditioner::Automatic;
      break;
  }
  task.IsPreconditioner = this->Scheme != SCHEME_EXPLICIT_REACTION;
  return std::make_unique<HarmonicMap>(input.Surface.Operators, std::move(coefficients),
    std::move(input.Data), settings, input.Solver("harmonic", task), input.Parallel);
}

//------------------------------------------------------------------------------------------------
void vtkHarmonicMapFilter::PrepareResult(
  const SurfaceRun& run, const SurfaceDiffusion::ProgressMonitor& progress)
{
  if (!this->MoveVertices)
  {
    return;
  }
  const PolyDataSurface& surface = *run.Surface;
  const TriangleMesh& mesh = *surface.InputMesh;
  IterationLimits limits;
  limits.Tolerance = this->Tolerance;
  limits.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  VertexMotion motion;
  const Points moved = UpdateVerticesFromNormals(mesh, surface.Points, run.Path->State(),
    FitRange * run.Units.MeanEdgeLength, motion, limits, SMPParallelFor::Instance(), progress);

  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(NewArray<vtkDoubleArray>("Points", 3, surface.Points.rows()));
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    Eigen::RowVector3d x = surface.Points.row(i);
    if (surface.PointToVertex[i] >= 0) // points merged into one vertex move together
    {
      const Index vertex = mesh.InputVertex()[surface.PointToVertex[i]];
      x += moved.row(vertex) - surface.Points.row(vertex);
    }
    points->SetPoint(i, x.data());
  }
  this->MovedPoints[&run] = points;

  const double area = mesh.ControlAreas().sum() * mesh.LengthUnit() * mesh.LengthUnit();
  this->MovedArea += area;
  this->MeanDisplacement +=
    (motion.MeanDisplacement - this->MeanDisplacement) * (area / this->MovedArea);
  this->MaximumDisplacement = std::max(this->MaximumDisplacement, motion.MaximumDisplacement);
  this->VolumeBefore += motion.VolumeBefore;
  this->VolumeAfter += motion.VolumeAfter;
}

void vtkHarmonicMapFilter::WriteResult(
  const SurfaceRun& run, const BlockArrays& arrays, vtkPolyData* output)
{
  vtkPointData* data = output->GetPointData();
  const bool isNormals = this->IsNormals(arrays.Data, output);
  const bool isColour = arrays.Data->GetDataType() == VTK_UNSIGNED_CHAR;
  const int type = this->FindResultType(arrays);
  Values state = run.Path->State();
  if (type == VTK_UNSIGNED_CHAR)
  {
    const Values given = ReadPointData(*run.Surface, arrays.Data, nullptr, nullptr, 1.0).Given;
    state.array().colwise() *= given.rowwise().norm().array(); // the input's brightness
  }
  const int index = data->AddArray(
    WritePointArray(*run.Surface, arrays.Data, state, 1.0, type, this->FindResultName(arrays)));
  const bool isVector = arrays.Data->GetNumberOfComponents() == 3 && !isColour;
  int attribute = isVector ? vtkDataSetAttributes::VECTORS : vtkDataSetAttributes::SCALARS;
  if (isNormals && this->UseAsNormals)
  {
    attribute = vtkDataSetAttributes::NORMALS; // alone: ParaView would not shade with vectors
  }
  data->SetActiveAttribute(index, attribute);
  const auto moved = this->MovedPoints.find(&run);
  if (moved != this->MovedPoints.end())
  {
    output->SetPoints(ConvertPoints(moved->second, output->GetPoints()->GetDataType()));
  }
}

void vtkHarmonicMapFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->MeanDisplacement);
  visit(this->MaximumDisplacement);
  visit(this->VolumeBefore);
  visit(this->VolumeAfter);
}

void vtkHarmonicMapFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  const auto onOff = [](bool on) { return on ? "On" : "Off"; };
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Exponent: " << this->Exponent << "\n";
  os << indent << "Beta: " << this->Beta << "\n";
  os << indent << "Scheme: " << this->GetSchemeAsString() << "\n";
  os << indent << "ConsistentReaction: " << onOff(this->ConsistentReaction) << "\n";
  os << indent << "ProjectToSphere: " << onOff(this->ProjectToSphere) << "\n";
  os << indent << "LineField: " << onOff(this->LineField) << "\n";
  os << indent << "UseAsNormals: " << onOff(this->UseAsNormals) << "\n";
  os << indent << "MoveVertices: " << onOff(this->MoveVertices) << "\n";
  os << indent << "MeanDisplacement: " << this->MeanDisplacement << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
  os << indent << "VolumeBefore: " << this->VolumeBefore << "\n";
  os << indent << "VolumeAfter: " << this->VolumeAfter << "\n";
}
