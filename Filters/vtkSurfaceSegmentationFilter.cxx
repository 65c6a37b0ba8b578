// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceSegmentationFilter.h"

#include "Conversion/InputArrays.h"
#include "Conversion/LineWriter.h"
#include "Conversion/NewArray.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Run/ConvertValue.h"
#include "Run/SegmentationSettings.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <limits>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceSegmentationFilter);

namespace
{

/// Of means with a wrong region or component that one message lists.
constexpr std::size_t LargestNumberOfPlaces = 10;

constexpr double NotSet = std::numeric_limits<double>::quiet_NaN();

double FindMean(const std::map<std::pair<int, int>, double>& means, int region, int component)
{
  const auto entry = means.find({ region, component });
  return entry == means.end() ? NotSet : entry->second;
}

/// One row per point: that of its vertex, 0 at points of no participating triangle.
Values StateOfPoints(const Surface& surface, const Values& u)
{
  Values ofPoints = Values::Zero(surface.Points().rows(), u.cols());
  for (Index i = 0; i < static_cast<Index>(ofPoints.rows()); ++i)
  {
    const Index v = surface.VertexOf(i);
    if (v >= 0)
    {
      ofPoints.row(i) = u.row(v);
    }
  }
  return ofPoints;
}

/// The mean of the region of each label; zero for label 0.
Values MeansOfLabels(const Values& means, const std::vector<Index>& labels)
{
  Values rows = Values::Zero(static_cast<Eigen::Index>(labels.size()), means.cols());
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    if (labels[i] > 0)
    {
      rows.row(static_cast<Eigen::Index>(i)) = means.row(labels[i] - 1);
    }
  }
  return rows;
}

} // namespace

vtkSurfaceSegmentationFilter::vtkSurfaceSegmentationFilter()
  : Superclass(OwnedSettings::Make<SegmentationSettings>())
{
  this->SetNumberOfOutputPorts(3);
}

void vtkSurfaceSegmentationFilter::SetMean(int region, int component, double value)
{
  const auto entry = this->Means.find({ region, component });
  if (entry == this->Means.end() || entry->second != value)
  {
    this->Means[{ region, component }] = value;
    this->PassMeans();
  }
}

double vtkSurfaceSegmentationFilter::GetMean(int region, int component)
{
  return FindMean(this->Means, region, component);
}

void vtkSurfaceSegmentationFilter::RemoveAllMeans()
{
  if (!this->Means.empty())
  {
    this->Means.clear();
    this->PassMeans();
  }
}

/// The settings have the means in the order of regions and components, without their places.
void vtkSurfaceSegmentationFilter::PassMeans()
{
  auto& means = static_cast<SegmentationSettings&>(this->GetSettings()).Means;
  means.clear();
  for (const auto& [place, value] : this->Means)
  {
    means.push_back(value);
  }
  this->Modified();
}

void vtkSurfaceSegmentationFilter::AddMean(double region, double component, double value)
{
  this->SetMean(ConvertValue<int>(region), ConvertValue<int>(component), value);
}

double vtkSurfaceSegmentationFilter::GetEffectiveMean(int region, int component)
{
  return FindMean(this->EffectiveMeans, region, component);
}

/// The settings check the number of means. If it is right, each region and component has one.
void vtkSurfaceSegmentationFilter::CheckPlacesOfMeans(int components, Problems& problems) const
{
  const std::string regions = "1 to NumberOfRegions " + std::to_string(this->GetNumberOfRegions());
  const std::string columns =
    "0 to " + std::to_string(components - 1) + ", the last component of InputArray";
  const std::size_t limit = problems.size() + LargestNumberOfPlaces;
  for (const auto& [place, value] : this->Means)
  {
    if (problems.size() >= limit)
    {
      return;
    }
    const auto [region, component] = place;
    Require(region >= 1 && region <= this->GetNumberOfRegions(), "the region of a Mean", region,
      regions.c_str(), problems);
    Require(component >= 0 && component < components, "the component of a Mean", component,
      columns.c_str(), problems);
  }
}

bool vtkSurfaceSegmentationFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  const std::size_t before = problems.size();
  constexpr int any = InputArrays::AnyNumberOfComponents;
  fields.Data = inputs.Find(7, "DataTermArray", any, fields.DataOnCells);
  fields.DataAreTerms = fields.Data != nullptr;
  if (!fields.DataAreTerms && problems.size() == before && fields.Absent.empty())
  {
    fields.Data = inputs.Find(0, "InputArray", any, fields.DataOnCells);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1, fields.MaskOnCells);
  fields.Fidelity = inputs.Find(5, "FidelityArray", 1, fields.FidelityOnCells);
  fields.Seeds = inputs.Find(6, "SeedArray", 1, fields.SeedsOnCells);
  if (fields.Data && !fields.DataAreTerms && !this->GetAutomaticMeans())
  {
    this->CheckPlacesOfMeans(NumberOfDataComponents(fields.Data), problems);
  }
  return fields.Data != nullptr;
}

void vtkSurfaceSegmentationFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  const Surface& surface = *block.Surface;
  const RegionResults& regions = *block.Result.Regions;
  const bool onCells = this->HasResultOnCells(fields);
  vtkDataSetAttributes* const attributes = this->FindResultAttributes(fields, output);
  const Values& u = block.Path->State();
  const std::vector<Index> labels = onCells ? MakeCellLabels(*block.Cells, u) : regions.Labels;
  const int type = this->FindResultType(fields);
  if (regions.Means.rows() > 0)
  {
    const Values segmented = MeansOfLabels(regions.Means, labels);
    const std::string name = this->FindResultName(fields);
    this->AddResult(onCells
        ? WriteCellArray(*block.Cells, fields.Data, segmented, type, name)
        : WritePointArray(surface, fields.Data, fields.DataOnCells, segmented, 1.0, type, name),
      fields, attributes);
  }
  const bool single = type == VTK_FLOAT || this->OutputPrecision == OUTPUT_PRECISION_SINGLE;
  this->AddResult(WriteRows(this->FindOtherName("RegionProbability"),
                    onCells ? block.Cells->Transfer.ToCells(u) : StateOfPoints(surface, u), single),
    fields, attributes);
  const vtkIdType count = onCells ? output->GetNumberOfCells() : output->GetNumberOfPoints();
  const std::string idName = this->FindOtherName("RegionId");
  const auto ids = NewArray<vtkIntArray>(idName, 1, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const Index row = onCells ? static_cast<Index>(i) : surface.VertexOf(static_cast<Index>(i));
    ids->SetValue(i, row >= 0 ? labels[static_cast<std::size_t>(row)] : 0);
  }
  this->AddResult(ids, fields, attributes);
  attributes->SetActiveScalars(idName.c_str());
}

/// The rows of all blocks, one after the other.
void vtkSurfaceSegmentationFilter::WriteTable(vtkTable* table)
{
  const auto addColumn = [table](auto column, const std::string& name)
  {
    column->SetName(name.c_str());
    table->AddColumn(column);
    return column;
  };
  const auto blocks = addColumn(vtkSmartPointer<vtkIntArray>::New(), "Block");
  const auto numbers = addColumn(vtkSmartPointer<vtkIntArray>::New(), "Region");
  const auto areas = addColumn(vtkSmartPointer<vtkDoubleArray>::New(), "Area");
  const auto lengths = addColumn(vtkSmartPointer<vtkDoubleArray>::New(), "BoundaryLength");
  const auto components = addColumn(vtkSmartPointer<vtkIntArray>::New(), "Components");
  std::vector<vtkSmartPointer<vtkDoubleArray>> means;
  for (std::size_t b = 0; b < this->Regions.size(); ++b)
  {
    const RegionResults& regions = *this->Regions[b];
    while (static_cast<Eigen::Index>(means.size()) < regions.DataMeans.cols())
    {
      // A table takes only columns that are as long as the others.
      means.push_back(vtkSmartPointer<vtkDoubleArray>::New());
      means.back()->SetNumberOfTuples(blocks->GetNumberOfTuples());
      means.back()->Fill(NotSet);
      addColumn(means.back(), "Mean_" + std::to_string(means.size() - 1));
    }
    for (Eigen::Index k = 0; k < regions.Areas.size(); ++k)
    {
      blocks->InsertNextValue(static_cast<int>(b));
      numbers->InsertNextValue(static_cast<int>(k) + 1);
      areas->InsertNextValue(regions.Areas[k]);
      lengths->InsertNextValue(regions.BoundaryLengths[k]);
      components->InsertNextValue(regions.Components[static_cast<std::size_t>(k)]);
      for (std::size_t c = 0; c < means.size(); ++c)
      {
        const auto column = static_cast<Eigen::Index>(c);
        means[c]->InsertNextValue(
          column < regions.DataMeans.cols() ? regions.DataMeans(k, column) : NotSet);
      }
    }
  }
  this->Regions.clear();
}

vtkSmartPointer<vtkPolyData> vtkSurfaceSegmentationFilter::MakeBoundaries() const
{
  LineWriter lines;
  std::vector<int> regions, blocks;
  std::vector<double> lengths;
  for (std::size_t b = 0; b < this->Regions.size(); ++b)
  {
    const RegionBoundaries& found = this->Regions[b]->Boundaries;
    const vtkTypeInt64 first = lines.NumberOfPoints();
    for (const auto& point : found.Points.rowwise())
    {
      lines.AddPoint(point.data());
    }
    for (const RegionBoundary& curve : found.Curves)
    {
      for (const Index point : curve.Points)
      {
        lines.Connectivity.push_back(first + point);
      }
      lines.EndLine();
      regions.insert(regions.end(), { curve.Regions[0], curve.Regions[1] });
      lengths.push_back(curve.Length);
      blocks.push_back(static_cast<int>(b));
    }
  }
  auto boundaries = vtkSmartPointer<vtkPolyData>::New();
  lines.Write(boundaries);
  boundaries->GetCellData()->AddArray(CopyToArray<vtkIntArray>("Regions", 2, regions));
  boundaries->GetCellData()->AddArray(CopyToArray<vtkDoubleArray>("Length", 1, lengths));
  boundaries->GetCellData()->AddArray(CopyToArray<vtkIntArray>("Block", 1, blocks));
  return boundaries;
}

void vtkSurfaceSegmentationFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->EffectiveFidelityWeight = this->State->Run.ReportedBlock().Result.EffectiveFidelityWeight;
  this->Gap = this->LabelGap = 0.0;
  this->NumberOfAlternations = 0;
  this->EffectiveMeans.clear();
  this->Regions.clear();
  for (std::size_t b = 0; b < this->State->Run.NumberOfBlocks(); ++b)
  {
    this->Regions.push_back(this->State->Run.GetBlock(b).Result.Regions);
    const RegionResults& regions = *this->Regions.back();
    this->Gap = std::max(this->Gap, regions.Gap);
    this->LabelGap = std::max(this->LabelGap, regions.LabelGap);
    this->NumberOfAlternations = std::max(this->NumberOfAlternations, regions.NumberOfAlternations);
    const bool empty = this->State->Run.GetBlock(b).Surface->Mesh().NumberOfVertices() == 0;
    for (Eigen::Index k = 0; !empty && k < regions.Means.rows(); ++k)
    {
      for (Eigen::Index c = 0; c < regions.Means.cols(); ++c)
      {
        this->EffectiveMeans.insert(
          { { static_cast<int>(k) + 1, static_cast<int>(c) }, regions.Means(k, c) });
      }
    }
  }
  this->Curves = this->MakeBoundaries();
}

void vtkSurfaceSegmentationFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
  visit(this->Gap);
  visit(this->LabelGap);
  double alternations = this->NumberOfAlternations;
  visit(alternations);
  this->NumberOfAlternations = static_cast<int>(alternations);
}

//------------------------------------------------------------------------------------------------
void vtkSurfaceSegmentationFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (const auto& [place, value] : this->Means)
  {
    os << indent << "Mean of region " << place.first << ", component " << place.second << ": "
       << value << "\n";
  }
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
  os << indent << "Gap: " << this->Gap << "\n";
  os << indent << "LabelGap: " << this->LabelGap << "\n";
  os << indent << "NumberOfAlternations: " << this->NumberOfAlternations << "\n";
}
