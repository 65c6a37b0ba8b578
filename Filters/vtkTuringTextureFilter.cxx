// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTuringTextureFilter.h"

#include "Conversion/InputArrays.h"
#include "Conversion/MirroredEnum.h"
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

using Self = vtkTuringTextureFilter;
SURFACEDIFFUSION_MIRROR(Self::KINETICS_TURING, KineticsName::Turing);
SURFACEDIFFUSION_MIRROR(Self::KINETICS_SCHNAKENBERG, KineticsName::Schnakenberg);
SURFACEDIFFUSION_MIRROR(Self::KINETICS_GRAY_SCOTT, KineticsName::GrayScott);
SURFACEDIFFUSION_MIRROR(Self::KINETICS_BRUSSELATOR, KineticsName::Brusselator);
SURFACEDIFFUSION_MIRROR(Self::KINETICS_GIERER_MEINHARDT, KineticsName::GiererMeinhardt);
SURFACEDIFFUSION_MIRROR(Self::KINETICS_FITZ_HUGH_NAGUMO, KineticsName::FitzHughNagumo);

vtkTuringTextureFilter::vtkTuringTextureFilter()
{
  this->TimeIntegrator = TIME_INTEGRATOR_SECOND_ORDER;
  this->TimeStep = 1.0 / 16.0;
  this->NumberOfTimeSteps = 640;
  // An initial state is optional: the active scalars are not used by default.
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
}

const char* vtkTuringTextureFilter::GetKineticsAsString()
{
  return this->FindSettingWord("Kinetics");
}

const char* vtkTuringTextureFilter::GetTextureChemicalAsString()
{
  return this->FindSettingWord("TextureChemical");
}

void vtkTuringTextureFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetKineticsToTuring();
}

std::unique_ptr<RunSettings> vtkTuringTextureFilter::MakeSettings() const
{
  auto settings = std::make_unique<TextureSettings>();
  this->CopyProperties(*settings);
  settings->Kinetics = static_cast<KineticsName>(this->Kinetics);
  settings->ReactionRate = this->ReactionRate;
  settings->DiffusionRate1 = this->DiffusionRate1;
  settings->DiffusionRate2 = this->DiffusionRate2;
  settings->DiffusionRateAcross1 = this->DiffusionRateAcross1;
  settings->DiffusionRateAcross2 = this->DiffusionRateAcross2;
  settings->FeatureSize = this->FeatureSize;
  settings->InitialNoise = this->InitialNoise;
  settings->ClampToNonNegative = this->ClampToNonNegative;
  settings->AutomaticTimeStep = this->AutomaticTimeStep;
  settings->StopTolerance = this->StopTolerance;
  settings->CoarseStartSize = this->CoarseStartSize;
  settings->TextureChemical = this->TextureChemical;
  settings->ColorOutput = this->ColorOutput;
  // The order is that of KineticsName, and that of the parameters of each kinetics.
  settings->Parameters = { { { this->GrowthRate, this->DecayRate, 0.0 },
    { this->ActivatorSupply, this->SubstrateSupply, 0.0 }, { this->FeedRate, this->KillRate, 0.0 },
    { this->ReactantA, this->ReactantB, 0.0 }, { this->InhibitorDecayRate, this->Saturation, 0.0 },
    { this->RecoveryRate, this->RecoveryDamping, this->Stimulus } } };
  return settings;
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
  const Vector texture = StretchContrast(u.col(this->TextureChemical), block.Result.ContrastLimits);
  this->AddResult(
    WriteScalars(surface, this->FindOtherName("Texture"), texture, single, nullptr, 0), fields,
    points);
  std::string active = this->FindOtherName("u1");
  if (this->ColorOutput)
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
