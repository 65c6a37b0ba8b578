// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDenoisingFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/MirroredEnum.h"
#include "Conversion/NewArray.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SurfaceReader.h"
#include "Run/DenoisingRun.h"

#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <sstream>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDenoisingFilter);

using Self = vtkSurfaceDenoisingFilter;
SURFACEDIFFUSION_MIRROR(Self::SURFACE_TYPE_AUTOMATIC, SurfaceDiffusion::SurfaceType::Automatic);
SURFACEDIFFUSION_MIRROR(Self::SURFACE_TYPE_CAD, SurfaceDiffusion::SurfaceType::CAD);
SURFACEDIFFUSION_MIRROR(Self::SURFACE_TYPE_ORGANIC, SurfaceDiffusion::SurfaceType::Organic);

/// One run per block, and the cells of its triangles.
struct vtkSurfaceDenoisingFilter::RunState
{
  struct Block
  {
    DenoisingRun Run{ SMPParallelFor::Instance() };
    std::vector<vtkIdType> Cells;
  };
  std::vector<std::unique_ptr<Block>> Blocks;
};

namespace
{

/// The displacement of each point, with the name of the result.
vtkSmartPointer<vtkDataArray> WriteDisplacement(const DenoisingRun& run, const std::string& name)
{
  const Points& given = run.GetSurface().Points();
  const Points& moved = run.MovedPoints();
  auto result = NewArray<vtkDoubleArray>(name, 3, given.rows());
  for (Eigen::Index i = 0; i < given.rows(); ++i)
  {
    const Eigen::RowVector3d displacement = moved.row(i) - given.row(i);
    result->SetTuple(i, displacement.data());
  }
  return result;
}

} // namespace

vtkSurfaceDenoisingFilter::vtkSurfaceDenoisingFilter()
  : State(std::make_unique<RunState>())
{
  this->ResultArrayName = "Displacement";
}

vtkSurfaceDenoisingFilter::~vtkSurfaceDenoisingFilter() = default;

const char* vtkSurfaceDenoisingFilter::GetSurfaceTypeAsString()
{
  return FindWord(*this->MakeSettings(), "SurfaceType");
}

std::unique_ptr<DenoisingRunSettings> vtkSurfaceDenoisingFilter::MakeSettings() const
{
  auto settings = std::make_unique<DenoisingRunSettings>();
  settings->NoiseLevel = this->NoiseLevel;
  settings->SurfaceType = static_cast<SurfaceDiffusion::SurfaceType>(this->SurfaceType);
  settings->MergeCoincidentPoints = this->MergeCoincidentPoints;
  settings->MergeTolerance = this->MergeTolerance;
  return settings;
}

void vtkSurfaceDenoisingFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  const auto settings = this->MakeSettings();
  Problems problems;
  CheckRanges(*settings, problems);
  this->CheckSurfaceProperties(problems);
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    const InputArrays inputs(this, surfaces[b].Input, problems);
    fields[b].Fixed = inputs.Find(3, "FixedArray", 1, fields[b].FixedOnCells);
  }
  if (this->ReportProblems(problems))
  {
    return;
  }

  std::vector<Warning> warnings;
  Fingerprint versions;
  Index degenerate = 0;
  double length = 0.0;
  double edges = 0.0;
  double moved = 0.0;
  double vertices = 0.0;
  double noise = 0.0;
  double farthest = 0.0;
  this->State->Blocks.resize(surfaces.size());
  std::vector<vtkSmartPointer<vtkDataArray>> results;
  std::vector<vtkSmartPointer<vtkPoints>> points;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    auto& block = this->State->Blocks[b];
    if (!block)
    {
      block = std::make_unique<RunState::Block>();
    }
    vtkPolyData* const data = surfaces[b].Input;
    BlockInput input;
    input.SurfaceVersion = FingerprintSurface(data, nullptr);
    input.FieldsVersion = FingerprintFields(fields[b]);
    input.ReadSurface = [&] { return ReadSurface(data, nullptr, false, block->Cells); };
    input.ReadFields = [&]
    { return ReadFields(fields[b], block->Cells, data->GetNumberOfCells()); };
    const double count = static_cast<double>(surfaces.size());
    block->Run.Update(input, *settings, progress.Part(b / count, (b + 0.98) / count));
    results.push_back(WriteDisplacement(block->Run, this->ResultArrayName));
    points.push_back(WritePoints(block->Run.MovedPoints(), data->GetPoints()));
    const TriangleMesh& mesh = block->Run.GetSurface().InputMesh();
    const DenoisingReport& report = block->Run.Report();
    length += mesh.TotalEdgeLength() * mesh.LengthUnit();
    edges += mesh.NumberOfEdges();
    vertices += mesh.NumberOfVertices();
    moved += report.MeanDisplacement * mesh.NumberOfVertices();
    noise = std::max(noise, report.NoiseLevel);
    farthest = std::max(farthest, report.MaximumDisplacement);
    degenerate += block->Run.GetSurface().Diagnostics().DegenerateTriangles;
    versions.Add(block->Run.GetSurfaceVersion());
  }
  this->BeginWriting();
  std::vector<std::string> replaced;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    surfaces[b].Output->SetPoints(points[b]);
    if (ReplaceArray(results[b], nullptr, surfaces[b].Output->GetPointData()))
    {
      replaced.push_back(this->ResultArrayName);
    }
  }
  this->MeanEdgeLength = edges > 0.0 ? length / edges : 1.0;
  this->EffectiveNoiseLevel = noise;
  this->MeanDisplacement = vertices > 0.0 ? moved / vertices : 0.0;
  this->MaximumDisplacement = farthest;
  if (degenerate > 0)
  {
    warnings.push_back(
      { std::to_string(degenerate) + " triangles of zero area have no normal", versions });
  }
  if (!replaced.empty())
  {
    warnings.push_back({ DescribeReplacement(replaced), Fingerprint() });
  }
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDenoisingFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveNoiseLevel);
  visit(this->MeanDisplacement);
  visit(this->MaximumDisplacement);
}

void vtkSurfaceDenoisingFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Blocks.clear();
}

void vtkSurfaceDenoisingFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  std::ostringstream spaces;
  spaces << indent;
  os << Describe(*this->MakeSettings(), spaces.str());
  os << indent << "EffectiveNoiseLevel: " << this->EffectiveNoiseLevel << "\n";
  os << indent << "MeanDisplacement: " << this->MeanDisplacement << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
}
