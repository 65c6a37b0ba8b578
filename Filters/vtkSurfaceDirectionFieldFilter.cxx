// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDirectionFieldFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/MirroredEnum.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SurfaceReader.h"
#include "Run/DirectionFieldRun.h"

#include "vtkCellData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <sstream>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDirectionFieldFilter);

using Self = vtkSurfaceDirectionFieldFilter;
SURFACEDIFFUSION_MIRROR(Self::METHOD_PRINCIPAL_CURVATURE, DirectionMethod::PrincipalCurvature);
SURFACEDIFFUSION_MIRROR(Self::METHOD_CURVATURE_ALIGNED, DirectionMethod::CurvatureAligned);
SURFACEDIFFUSION_MIRROR(Self::METHOD_SMOOTH, DirectionMethod::Smooth);
SURFACEDIFFUSION_MIRROR(Self::METHOD_HINTS, DirectionMethod::Hints);

/// One run per block, and the cells of its triangles.
struct vtkSurfaceDirectionFieldFilter::RunState
{
  struct Block
  {
    DirectionFieldRun Run{ SMPParallelFor::Instance() };
    std::vector<vtkIdType> Cells;
  };
  std::vector<std::unique_ptr<Block>> Blocks;
};

vtkSurfaceDirectionFieldFilter::vtkSurfaceDirectionFieldFilter()
  : State(std::make_unique<RunState>())
{
  this->ResultArrayName = "Direction";
}

vtkSurfaceDirectionFieldFilter::~vtkSurfaceDirectionFieldFilter() = default;

const char* vtkSurfaceDirectionFieldFilter::GetMethodAsString()
{
  return FindWord(*this->MakeSettings(), "Method");
}

const char* vtkSurfaceDirectionFieldFilter::GetPrincipalDirectionAsString()
{
  return FindWord(*this->MakeSettings(), "PrincipalDirection");
}

std::unique_ptr<DirectionFieldSettings> vtkSurfaceDirectionFieldFilter::MakeSettings() const
{
  auto settings = std::make_unique<DirectionFieldSettings>();
  settings->Method = static_cast<DirectionMethod>(this->Method);
  settings->PrincipalDirection = this->PrincipalDirection;
  settings->SmoothingLength = this->SmoothingLength;
  settings->HintWeight = this->HintWeight;
  settings->Angle = this->Angle;
  settings->MergeCoincidentPoints = this->MergeCoincidentPoints;
  settings->MergeTolerance = this->MergeTolerance;
  return settings;
}

void vtkSurfaceDirectionFieldFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  const auto settings = this->MakeSettings();
  Problems problems;
  settings->Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  for (std::size_t b = 0; b < surfaces.size() && settings->Method == DirectionMethod::Hints; ++b)
  {
    const std::size_t before = problems.size();
    fields[b].Direction = InputArrays(this, surfaces[b].Input, problems)
                            .Find(2, "DirectionArray", 3, fields[b].DirectionOnCells);
    if (problems.size() == before)
    {
      const FieldSummary summary = fields[b].Summarize();
      settings->Check(&summary, problems);
    }
  }
  if (this->ReportProblems(problems))
  {
    return;
  }

  Index degenerate = 0;
  std::vector<Warning> warnings;
  Fingerprint versions;
  double length = 0.0;
  double edges = 0.0;
  this->State->Blocks.resize(surfaces.size());
  std::vector<vtkSmartPointer<vtkDataArray>> results;
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
    block->Run.Update(input, *settings, progress.Part(b / count, (b + 0.95) / count));
    results.push_back(WriteDirections(block->Run.GetSurface(), block->Cells, data,
      block->Run.Directions(), this->ResultArrayName, SMPParallelFor::Instance()));
    const TriangleMesh& mesh = block->Run.GetSurface().Mesh();
    length += mesh.TotalEdgeLength() * mesh.LengthUnit();
    edges += mesh.NumberOfEdges();
    degenerate += block->Run.GetSurface().Diagnostics().DegenerateTriangles;
    versions.Add(block->Run.GetSurfaceVersion());
    const std::vector<Warning> found = block->Run.FindWarnings();
    warnings.insert(warnings.end(), found.begin(), found.end());
  }
  this->BeginWriting();
  std::vector<std::string> replaced;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    vtkCellData* const cells = surfaces[b].Output->GetCellData();
    if (ReplaceArray(results[b], fields[b].Direction, cells))
    {
      replaced.push_back(this->ResultArrayName);
    }
    cells->SetActiveVectors(this->ResultArrayName.c_str());
  }
  this->MeanEdgeLength = edges > 0.0 ? length / edges : 1.0;
  if (degenerate > 0)
  {
    warnings.push_back(
      { std::to_string(degenerate) + " triangles of zero area get no direction", versions });
  }
  if (!replaced.empty())
  {
    warnings.push_back({ DescribeReplacement(replaced), Fingerprint() });
  }
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceDirectionFieldFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Blocks.clear();
}

void vtkSurfaceDirectionFieldFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  std::ostringstream spaces;
  spaces << indent;
  os << Describe(*this->MakeSettings(), spaces.str());
}
