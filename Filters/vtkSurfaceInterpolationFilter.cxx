// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceInterpolationFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/PointInput.h"
#include "Run/InterpolationSettings.h"
#include "Run/OwnedSettings.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <limits>
#include <vector>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceInterpolationFilter);

vtkSurfaceInterpolationFilter::vtkSurfaceInterpolationFilter()
  : Superclass(OwnedSettings::Make<InterpolationSettings>())
{
  this->DeclareNumber("EffectiveSmoothing");
  this->DeclareNumber("NumberOfValues");
  this->DeclareNumber("NumberOfFarValues");
  this->DeclareNumber("MedianDistance");
  this->DeclareNumber("LargestDistance");
  this->SetNumberOfInputPorts(2);
}

void vtkSurfaceInterpolationFilter::AddMissingValue(double value)
{
  this->GetMissingValues().push_back(value);
  this->Modified();
}

void vtkSurfaceInterpolationFilter::RemoveAllMissingValues()
{
  if (!this->GetMissingValues().empty())
  {
    this->GetMissingValues().clear();
    this->Modified();
  }
}

int vtkSurfaceInterpolationFilter::GetNumberOfMissingValues()
{
  return static_cast<int>(this->GetMissingValues().size());
}

double vtkSurfaceInterpolationFilter::GetMissingValue(int index)
{
  const bool isIn = index >= 0 && index < this->GetNumberOfMissingValues();
  return isIn ? this->GetMissingValues()[static_cast<std::size_t>(index)]
              : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double>& vtkSurfaceInterpolationFilter::GetMissingValues()
{
  return static_cast<InterpolationSettings&>(this->GetSettings()).MissingValue;
}

int vtkSurfaceInterpolationFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillInputPortInformation(port, info);
  }
  DescribePointPort(info);
  return 1;
}

int vtkSurfaceInterpolationFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* const points = FindOptionalInput(inputs, 1);
  this->HasPoints = points != nullptr;
  this->ProblemsOfPoints.clear();
  if (points)
  {
    this->Samples = ReadPointSamples(points, { this->PointValueArray, this->PointWeightArray },
      this->GetController(), this->ProblemsOfPoints);
  }
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  this->Samples.reset();
  return result;
}

bool vtkSurfaceInterpolationFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Samples = this->Samples;
  problems.insert(problems.end(), this->ProblemsOfPoints.begin(), this->ProblemsOfPoints.end());
  if (!this->HasPoints)
  {
    fields.Data = inputs.Find(0, "InputArray", InputArrays::AnyNumberOfComponents);
    fields.Fidelity = inputs.Find(5, "FidelityArray", 1);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3);
  return fields.Data.Values != nullptr || fields.Samples != nullptr;
}

void vtkSurfaceInterpolationFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PointValueArray: " << this->PointValueArray << "\n";
  os << indent << "PointWeightArray: " << this->PointWeightArray << "\n";
}
VTK_ABI_NAMESPACE_END
