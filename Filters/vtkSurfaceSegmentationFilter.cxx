// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceSegmentationFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Run/ConvertValue.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"
#include "Run/SegmentationSettings.h"

#include "vtkObjectFactory.h"

#include <limits>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceSegmentationFilter);

namespace
{

/// Of means with a wrong region or component that one message lists.
constexpr std::size_t LargestNumberOfPlaces = 10;

} // namespace

vtkSurfaceSegmentationFilter::vtkSurfaceSegmentationFilter()
  : Superclass(OwnedSettings::Make<SegmentationSettings>())
{
  this->DeclareNumber("EffectiveFidelityWeight");
  this->DeclareNumber("Gap");
  this->DeclareNumber("LabelGap");
  this->DeclareNumber("NumberOfAlternations");
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
  const auto entry = this->Means.find({ region, component });
  return entry == this->Means.end() ? std::numeric_limits<double>::quiet_NaN() : entry->second;
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
  return this->FindNumber("Means", region - 1, component);
}

/// The settings check the number of means. If it is right, each region and component has one.
void vtkSurfaceSegmentationFilter::CheckPlacesOfMeans(int components, Problems& problems) const
{
  const std::size_t limit = problems.size() + LargestNumberOfPlaces;
  for (const auto& [place, value] : this->Means)
  {
    if (problems.size() >= limit)
    {
      return;
    }
    const auto [region, component] = place;
    if (region < 1 || region > this->GetNumberOfRegions())
    {
      problems.push_back(Say("Region", region, this->GetNumberOfRegions()));
    }
    if (component < 0 || component >= components)
    {
      problems.push_back(Say("Component", component, components - 1));
    }
  }
}

bool vtkSurfaceSegmentationFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  const std::size_t before = problems.size();
  constexpr int any = InputArrays::AnyNumberOfComponents;
  fields.Data = inputs.Find(7, "DataTermArray", any);
  fields.DataAreTerms = fields.Data.Values != nullptr;
  if (!fields.DataAreTerms && problems.size() == before && fields.Absent.empty())
  {
    fields.Data = inputs.Find(0, "InputArray", any);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Fidelity = inputs.Find(5, "FidelityArray", 1);
  fields.Seeds = inputs.Find(6, "SeedArray", 1);
  if (fields.Data.Values && !fields.DataAreTerms && !this->GetAutomaticMeans())
  {
    this->CheckPlacesOfMeans(NumberOfDataComponents(fields.Data.Values), problems);
  }
  return fields.Data.Values != nullptr;
}

void vtkSurfaceSegmentationFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  for (const auto& [place, value] : this->Means)
  {
    os << indent << "Mean of region " << place.first << ", component " << place.second << ": "
       << value << "\n";
  }
}
VTK_ABI_NAMESPACE_END
