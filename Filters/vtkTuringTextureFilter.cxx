// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTuringTextureFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"
#include "Run/TextureSettings.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

#include <vector>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkTuringTextureFilter);

vtkTuringTextureFilter::vtkTuringTextureFilter()
  : Superclass(OwnedSettings::Make<TextureSettings>())
{
  this->DeclareNumber("Wavelength");
  this->DeclareNumber("WavelengthGrowthRate");
  this->DeclareNumber("DiffusionRateFactor", 1.0);
  this->DeclareNumber("CoarseStartVertices");
  this->RefineTo = RefineAutomatically;
  // An initial state is optional: the active scalars are not used by default.
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
}

void vtkTuringTextureFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetTimeIntegratorToFirstOrder();
  this->SetKineticsToTuring();
}

double vtkTuringTextureFilter::FindRefinement(double meanEdgeLength, Sentence& explanation) const
{
  if (this->RefineTo != RefineAutomatically)
  {
    return this->Superclass::FindRefinement(meanEdgeLength, explanation);
  }
  const TextureSettings& settings = this->GetTextureSettings();
  const double size = settings.FeatureSize;
  const double length = settings.EdgeLengthForFeatures(meanEdgeLength);
  if (length > 0.0)
  {
    explanation = Say("Features", size, size / meanEdgeLength);
  }
  return length;
}

bool vtkTuringTextureFilter::FindFields(vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  vtkInformation* const data = this->GetInputArrayInformation(0);
  const char* const name =
    data->Has(vtkDataObject::FIELD_NAME()) ? data->Get(vtkDataObject::FIELD_NAME()) : "";
  if (data->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) || (name && *name))
  {
    fields.Data = inputs.Find(0, "InputArray", 2);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3);
  fields.Fixed = inputs.Find(3, "FixedArray", 1);
  const LocatedArray rates = inputs.Find(4, "DiffusionRateArray", 4);
  fields.Rates = rates.Values;
  if (rates.Values && !rates.OnCells)
  {
    problems.push_back(Say("PointRates"));
  }
  return true; // an initial state is optional
}

namespace
{

void Fill(std::vector<double>& color, double red, double green, double blue, vtkObject* owner)
{
  const std::vector<double> given{ red, green, blue };
  if (color != given)
  {
    color = given;
    owner->Modified();
  }
}

} // namespace

#define COLOR(Name)                                                                                \
  void vtkTuringTextureFilter::Set##Name(double red, double green, double blue)                    \
  {                                                                                                \
    Fill(this->GetTextureSettings().Name, red, green, blue, this);                                 \
  }                                                                                                \
  void vtkTuringTextureFilter::Set##Name(const double color[3])                                    \
  {                                                                                                \
    this->Set##Name(color[0], color[1], color[2]);                                                 \
  }                                                                                                \
  double* vtkTuringTextureFilter::Get##Name()                                                      \
  {                                                                                                \
    return this->GetTextureSettings().Name.data();                                                 \
  }                                                                                                \
  void vtkTuringTextureFilter::Get##Name(double& red, double& green, double& blue)                 \
  {                                                                                                \
    const double* const color = this->Get##Name();                                                 \
    red = color[0];                                                                                \
    green = color[1];                                                                              \
    blue = color[2];                                                                               \
  }                                                                                                \
  void vtkTuringTextureFilter::Get##Name(double color[3])                                          \
  {                                                                                                \
    this->Get##Name(color[0], color[1], color[2]);                                                 \
  }
COLOR(LowColor)
COLOR(HighColor)
#undef COLOR

TextureSettings& vtkTuringTextureFilter::GetTextureSettings() const
{
  return static_cast<TextureSettings&>(this->GetSettings());
}
VTK_ABI_NAMESPACE_END
