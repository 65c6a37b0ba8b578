// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntrinsicTVFilter.h"

#include "Conversion/MirroredEnum.h"
#include "Conversion/RunState.h"
#include "Run/TotalVariationSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkIntrinsicTVFilter);

using Self = vtkIntrinsicTVFilter;
#define MIRROR_EDGE_FUNCTION(word, WORD)                                                           \
  SURFACEDIFFUSION_MIRROR(Self::EDGE_FUNCTION_##WORD, EdgeFunctionKind::word);                     \
  static_assert(Self::ACROSS_EDGE_FUNCTION_##WORD == Self::EDGE_FUNCTION_##WORD + 1, "0 is Same");
vtkIntrinsicTVFilterEdgeFunctions(MIRROR_EDGE_FUNCTION);
static_assert(Self::ACROSS_EDGE_FUNCTION_SAME == 0, "the settings' number of Same");
SURFACEDIFFUSION_MIRROR(Self::MODE_TIME_STEPS, TotalVariationMode::TimeSteps);
SURFACEDIFFUSION_MIRROR(Self::MODE_STEADY_STATE, TotalVariationMode::SteadyState);
SURFACEDIFFUSION_MIRROR(Self::CHANNEL_COUPLING_PER_CHANNEL, ChannelCoupling::PerChannel);
SURFACEDIFFUSION_MIRROR(Self::CHANNEL_COUPLING_JOINT, ChannelCoupling::Joint);
SURFACEDIFFUSION_MIRROR(Self::FIDELITY_NORM_L2, FidelityNorm::L2);
SURFACEDIFFUSION_MIRROR(Self::FIDELITY_NORM_L1, FidelityNorm::L1);
SURFACEDIFFUSION_MIRROR(Self::DISCRETIZATION_LINEAR, Discretization::Linear);
SURFACEDIFFUSION_MIRROR(Self::DISCRETIZATION_CROUZEIX_RAVIART, Discretization::CrouzeixRaviart);
SURFACEDIFFUSION_MIRROR(Self::COLOR_MODEL_RGB, ColorModel::RGB);
SURFACEDIFFUSION_MIRROR(Self::COLOR_MODEL_OPPONENT, ColorModel::Opponent);
SURFACEDIFFUSION_MIRROR(
  Self::COLOR_MODEL_CHROMATICITY_BRIGHTNESS, ColorModel::ChromaticityBrightness);

vtkIntrinsicTVFilter::vtkIntrinsicTVFilter()
{
  this->FidelityWeight = 3.0;
  this->Tolerance = 1e-3;
}

const char* vtkIntrinsicTVFilter::GetModeAsString()
{
  return this->FindSettingWord("Mode");
}

const char* vtkIntrinsicTVFilter::GetEdgeFunctionAsString()
{
  return this->FindSettingWord("EdgeFunction");
}

const char* vtkIntrinsicTVFilter::GetAcrossEdgeFunctionAsString()
{
  return this->FindSettingWord("AcrossEdgeFunction");
}

const char* vtkIntrinsicTVFilter::GetChannelCouplingAsString()
{
  return this->FindSettingWord("ChannelCoupling");
}

const char* vtkIntrinsicTVFilter::GetFidelityNormAsString()
{
  return this->FindSettingWord("FidelityNorm");
}

const char* vtkIntrinsicTVFilter::GetDiscretizationAsString()
{
  return this->FindSettingWord("Discretization");
}

const char* vtkIntrinsicTVFilter::GetColorModelAsString()
{
  return this->FindSettingWord("ColorModel");
}

void vtkIntrinsicTVFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
  this->SetEdgeFunctionToTotalVariation();
  this->SetAcrossEdgeFunctionToSame();
  this->SetChannelCouplingToPerChannel();
  this->SetFidelityNormToL2();
  this->SetAutomaticFidelity(false);
  this->SetDiscretizationToLinear();
  this->SetColorModelToRGB();
}

std::unique_ptr<RunSettings> vtkIntrinsicTVFilter::MakeSettings() const
{
  auto settings = std::make_unique<TotalVariationSettings>();
  this->CopyProperties(*settings);
  settings->Mode = static_cast<TotalVariationMode>(this->Mode);
  settings->EdgeFunction = static_cast<EdgeFunctionKind>(this->EdgeFunction);
  settings->AcrossEdgeFunction = this->AcrossEdgeFunction;
  settings->Beta = this->Beta;
  settings->EdgeThreshold = this->EdgeThreshold;
  settings->ChannelCoupling = static_cast<SurfaceDiffusion::ChannelCoupling>(this->ChannelCoupling);
  settings->FidelityNorm = static_cast<SurfaceDiffusion::FidelityNorm>(this->FidelityNorm);
  settings->AutomaticFidelity = this->AutomaticFidelity;
  settings->NoiseLevel = this->NoiseLevel;
  settings->Blur.FWHM = this->BlurFWHM;
  settings->Blur.Steps = this->BlurSteps;
  settings->Discretization = static_cast<SurfaceDiffusion::Discretization>(this->Discretization);
  settings->StopTolerance = this->StopTolerance;
  settings->Color.Model = static_cast<SurfaceDiffusion::ColorModel>(this->ColorModel);
  settings->Color.ChromaWeight = this->ChromaWeight;
  settings->Color.ChromaticityExponent = this->ChromaticityExponent;
  settings->Color.ChromaticityWeight = this->ChromaticityWeight;
  settings->Color.LinearLight = this->LinearLight;
  return settings;
}

void vtkIntrinsicTVFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->EffectiveFidelityWeight = this->State->Run.ReportedBlock().Result.EffectiveFidelityWeight;
}

void vtkIntrinsicTVFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
}

void vtkIntrinsicTVFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
}
