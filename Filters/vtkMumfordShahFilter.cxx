// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMumfordShahFilter.h"

#include "Conversion/LineWriter.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Run/MumfordShahSettings.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkMumfordShahFilter);

namespace
{

constexpr const char* EdgesName = "Edges";

/// The edges of all surfaces as polylines, with the values of 1 - v as point array `name`.
vtkSmartPointer<vtkPolyData> MakeCurves(const Run& run, const std::string& name)
{
  LineWriter lines;
  std::vector<double> edges, lengths;
  std::vector<int> blocks;
  for (std::size_t b = 0; b < run.NumberOfBlocks(); ++b)
  {
    const RunResult& result = run.GetBlock(b).Result;
    const Polylines& curves = result.EdgeCurves;
    for (Index l = 0; l < curves.NumberOfLines(); ++l)
    {
      const Index last = curves.Begin[l + 1] - 1;
      const bool closed = curves.Vertices[curves.Begin[l]] == curves.Vertices[last];
      const vtkTypeInt64 first = lines.NumberOfPoints();
      for (Index k = curves.Begin[l]; k < last || (k == last && !closed); ++k)
      {
        lines.Connectivity.push_back(lines.NumberOfPoints());
        lines.AddPoint(curves.Points.row(k).data());
        edges.push_back(result.Edges[curves.Vertices[k]]);
      }
      if (closed)
      {
        lines.Connectivity.push_back(first);
      }
      lines.EndLine();
      lengths.push_back(curves.Length(l));
      blocks.push_back(static_cast<int>(b));
    }
  }
  auto output = vtkSmartPointer<vtkPolyData>::New();
  lines.Write(output);
  output->GetPointData()->AddArray(CopyToArray<vtkDoubleArray>(name.c_str(), 1, edges));
  output->GetCellData()->AddArray(CopyToArray<vtkDoubleArray>("Length", 1, lengths));
  output->GetCellData()->AddArray(CopyToArray<vtkIntArray>("Block", 1, blocks));
  return output;
}

} // namespace

vtkMumfordShahFilter::vtkMumfordShahFilter()
  : Superclass(OwnedSettings::Make<MumfordShahSettings>())
{
  this->SetNumberOfOutputPorts(3);
}

vtkMumfordShahFilter::~vtkMumfordShahFilter() = default;

void vtkMumfordShahFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  const bool single = this->FindResultType(fields) == VTK_FLOAT;
  const std::string name = this->FindOtherName(EdgesName);
  const auto edges = this->HasResultOnCells(fields)
    ? WriteRows(name, block.Cells->Transfer.ToCells(block.Result.Edges), single)
    : WriteScalars(*block.Surface, name, block.Result.Edges, single, nullptr, 0);
  this->AddResult(edges, fields, this->FindResultAttributes(fields, output));
  this->Superclass::WriteResult(index, fields, output);
}

void vtkMumfordShahFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->Curves = MakeCurves(this->State->Run, this->FindOtherName(EdgesName));
  const RunResult& first = this->State->Run.GetBlock(0).Result;
  this->EffectiveEdgeThreshold = first.EffectiveEdgeThreshold;
  this->EffectiveSmoothingLength = first.EffectiveSmoothingLength;
  this->EstimatedNoiseLevel = first.EstimatedNoiseLevel;
  this->EdgeLength = 0.0;
  for (std::size_t b = 0; b < this->State->Run.NumberOfBlocks(); ++b)
  {
    const RunResult& result = this->State->Run.GetBlock(b).Result;
    for (Index l = 0; l < result.EdgeCurves.NumberOfLines(); ++l)
    {
      this->EdgeLength += result.EdgeCurves.Length(l);
    }
  }
}

void vtkMumfordShahFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveEdgeThreshold);
  visit(this->EffectiveSmoothingLength);
  visit(this->EstimatedNoiseLevel);
  visit(this->EdgeLength);
}

void vtkMumfordShahFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EffectiveEdgeThreshold: " << this->EffectiveEdgeThreshold << "\n";
  os << indent << "EffectiveSmoothingLength: " << this->EffectiveSmoothingLength << "\n";
  os << indent << "EstimatedNoiseLevel: " << this->EstimatedNoiseLevel << "\n";
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
}
