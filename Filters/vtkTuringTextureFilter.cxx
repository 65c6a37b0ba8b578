// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTuringTextureFilter.h"

#include "Conversion/InputArrays.h"
#include "Conversion/NewArray.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Core/Models/TextureColors.h"
#include "Run/TextureSettings.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkTuringTextureFilter);

vtkTuringTextureFilter::vtkTuringTextureFilter()
  : Superclass(OwnedSettings::Make<TextureSettings>())
{
  // An initial state is optional: the active scalars are not used by default.
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
}

void vtkTuringTextureFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetKineticsToTuring();
}

bool vtkTuringTextureFilter::FindFields(vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  vtkInformation* const data = this->GetInputArrayInformation(0);
  const char* const name =
    data->Has(vtkDataObject::FIELD_NAME()) ? data->Get(vtkDataObject::FIELD_NAME()) : "";
  if (data->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) || (name && *name))
  {
    fields.Data = inputs.Find(0, "InputArray", 2, fields.DataOnCells);
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1, fields.MaskOnCells);
  fields.Direction = inputs.Find(2, "DirectionArray", 3, fields.DirectionOnCells);
  fields.Fixed = inputs.Find(3, "FixedArray", 1, fields.FixedOnCells);
  bool onCells = true;
  fields.Rates = inputs.Find(4, "DiffusionRateArray", 4, onCells);
  if (fields.Rates && !onCells)
  {
    problems.emplace_back(
      "DiffusionRateArray is a point array; allowed: arrays of 4 components per cell");
  }
  for (int k = 0; k < 3; ++k)
  {
    const SettingRange share = SettingRange::ClosedUnitInterval();
    Require(share.Contains(this->LowColor[k]), "LowColor", this->LowColor[k], share.Text, problems);
    Require(
      share.Contains(this->HighColor[k]), "HighColor", this->HighColor[k], share.Text, problems);
  }
  return true; // an initial state is optional
}

void vtkTuringTextureFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  const Surface& surface = *block.Surface;
  const Values& u = block.Path->State();
  const bool single = this->OutputPrecision == OUTPUT_PRECISION_SINGLE ||
    (this->OutputPrecision == OUTPUT_PRECISION_INPUT && fields.Data &&
      fields.Data->GetDataType() == VTK_FLOAT);
  vtkPointData* const points = output->GetPointData();
  for (int c = 0; c < 2; ++c)
  {
    const std::string name = this->FindOtherName(c == 0 ? "u1" : "u2");
    vtkDataArray* const elsewhere = fields.DataOnCells ? nullptr : fields.Data.Get();
    this->AddResult(WriteScalars(surface, name, u.col(c), single, elsewhere, c), fields, points);
  }
  const Vector texture =
    StretchContrast(u.col(this->GetTextureChemical()), block.Result.ContrastLimits);
  this->AddResult(
    WriteScalars(surface, this->FindOtherName("Texture"), texture, single, nullptr, 0), fields,
    points);
  std::string active = this->FindOtherName("u1");
  if (this->GetColorOutput())
  {
    active = this->FindOtherName("TextureColor");
    const std::array<double, 3> low = { this->LowColor[0], this->LowColor[1], this->LowColor[2] };
    const std::array<double, 3> high = { this->HighColor[0], this->HighColor[1],
      this->HighColor[2] };
    const Colors vertexColors = MixColors(texture, low, high);
    const Colors elsewhere = MixColors(Vector::Zero(1), low, high);
    const auto colors = NewArray<vtkUnsignedCharArray>(active, 3, output->GetNumberOfPoints());
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      const Index v = surface.VertexOf(static_cast<Index>(i));
      colors->SetTypedTuple(i, v >= 0 ? vertexColors.row(v).data() : elsewhere.data());
    }
    this->AddResult(colors, fields, points);
  }
  points->SetActiveScalars(active.c_str());
}

void vtkTuringTextureFilter::TakeResults()
{
  this->Superclass::TakeResults();
  const RunResult& result = this->State->Run.GetBlock(0).Result;
  this->Wavelength = result.Wavelength;
  this->WavelengthGrowthRate = result.WavelengthGrowthRate;
  this->DiffusionRateFactor = result.DiffusionRateFactor;
  this->CoarseStartVertices = static_cast<vtkIdType>(result.CoarseStartVertices);
}

void vtkTuringTextureFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->Wavelength);
  visit(this->WavelengthGrowthRate);
  visit(this->DiffusionRateFactor);
  auto vertices = static_cast<double>(this->CoarseStartVertices);
  visit(vertices);
  this->CoarseStartVertices = static_cast<vtkIdType>(vertices);
}

void vtkTuringTextureFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LowColor: " << this->LowColor[0] << " " << this->LowColor[1] << " "
     << this->LowColor[2] << "\n";
  os << indent << "HighColor: " << this->HighColor[0] << " " << this->HighColor[1] << " "
     << this->HighColor[2] << "\n";
  os << indent << "Wavelength: " << this->Wavelength << "\n";
  os << indent << "WavelengthGrowthRate: " << this->WavelengthGrowthRate << "\n";
  os << indent << "DiffusionRateFactor: " << this->DiffusionRateFactor << "\n";
  os << indent << "CoarseStartVertices: " << this->CoarseStartVertices << "\n";
}
