// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/RandomFieldRun.h"
#include "Run/InputSentences.h"
#include "Run/UnlikeEdges.h"

#include "Core/Operators/CotanWeights.h"

#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

void RandomFieldSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "Covariance", "",
                   "Gaussian: fields are as smooth as white noise after the heat equation. "
                   "MaternNu1 and MaternNu3: the covariance is Matern's with nu = 1, a rougher "
                   "field without slopes, or nu = 3. Matern: nu is the Smoothness." },
    this->Covariance, { "Gaussian", "MaternNu1", "MaternNu3", "Matern" });
  visitor.Number({ "FWHM", "coordinates",
                   "Of Gaussian: full width at half maximum of the kernel that white noise would "
                   "be smoothed with, in the unit of the coordinates. 0: 10 h.",
                   "Covariance=Gaussian" },
    this->FWHM, SettingRange::NonNegative());
  visitor.Number({ "Range", "coordinates",
                   "Of Matern's: the distance at which the correlation has fallen to 0.14, "
                   "sqrt(8 nu)/kappa, in the unit of the coordinates. 0: 20 h.",
                   "Covariance!=Gaussian" },
    this->Range, SettingRange::NonNegative());
  SettingRange smoothness = SettingRange::Between(0.0, 4.0, "numbers above 0, up to 4");
  smoothness.LowIncluded = false;
  visitor.Number({ "Smoothness", "",
                   "nu of Matern's covariance, without a unit: fields have derivatives of orders "
                   "below it. With 0.5 "
                   "the correlation is exp(-kappa r). Other numbers than 1 and 3 take up to 14 "
                   "factors, and the covariance is exact to 0.5 % of the variance.",
                   "Covariance=Matern" },
    this->Smoothness, smoothness);
  visitor.Integer({ "NumberOfFields", "",
                    "The number of fields, which are independent: the components of the result." },
    this->NumberOfFields, SettingRange::AtLeast(1, "1 or more"));
  visitor.Integer({ "RandomSeed", "",
                    "The seed of the random numbers. Each number is a hash of the seed, the field "
                    "and the global id of the point or its coordinates." },
    this->RandomSeed, SettingRange::AnyFinite());
  visitor.Switch({ "Normalize", "",
                   "On: the variance is 1 at every point. Off: fields are divided by the standard "
                   "deviation on the plane, and have more variance near boundaries." },
    this->Normalize);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

double RandomFieldSettings::Nu() const
{
  return this->Covariance == Kind::Matern ? this->Smoothness
    : this->Covariance == Kind::MaternNu3 ? 3.0
                                          : 1.0;
}

double RandomFieldSettings::Width(double h) const
{
  constexpr double edgesOfGaussian = 10.0;
  constexpr double edgesOfMatern = 20.0;
  const bool isGaussian = this->Covariance == Kind::Gaussian;
  const double given = isGaussian ? this->FWHM : this->Range;
  return given > 0.0 ? given : (isGaussian ? edgesOfGaussian : edgesOfMatern) * h;
}

void RandomFieldRun::Update(
  const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<RandomFieldSettings&>(given);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  if (!this->Prepare(input, settings, options, progress.Part(0.0, 0.2)))
  {
    return;
  }
  this->Results.clear();
  this->Unresolved = Sentence();
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.Mesh();
  const double h = this->MeanEdgeLength();
  const double width = settings.Width(h);
  const bool isGaussian = settings.Covariance == RandomFieldSettings::Kind::Gaussian;
  if (width < 2.0 * h)
  {
    this->Unresolved = Say("Unresolved", Word::Setting(isGaussian ? "FWHM" : "Range"), width, h);
  }
  this->IsInEdges = !((isGaussian ? settings.FWHM : settings.Range) > 0.0);
  this->UnlikeEdges = this->IsInEdges ? SentenceOfUnlikeEdges(mesh) : Sentence();
  RandomField::Settings field;
  field.Covariance = isGaussian ? FieldCovariance::Gaussian : FieldCovariance::Matern;
  field.Nu = settings.Nu();
  field.Width = field.Range = width / mesh.LengthUnit();
  field.HasUnitVariance = settings.Normalize;
  Values fields(mesh.NumberOfVertices(), settings.NumberOfFields);
  RandomField source(surface.SharedAssembler(), CotanWeights(mesh, this->Parallel), field,
    MakeVertexIds(surface, this->ReadFields(input)), Vector(), this->Parallel,
    progress.Part(0.2, 0.6));
  source.Draw(settings.RandomSeed, 0, fields, progress.Part(0.6, 1.0));
  this->MissedResidual = source.MissedResidual();
  Output output{ "RandomField", Place::PerVertex, OutputType::Double, std::move(fields),
    Role::Scalars };
  output.Elsewhere =
    Values::Constant(1, settings.NumberOfFields, std::numeric_limits<double>::quiet_NaN());
  this->Results.push_back(std::move(output));
  this->Complete(input, settings);
}

std::vector<Warning> RandomFieldRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  if (!(this->Unresolved == Sentence()))
  {
    warnings.push_back({ this->Unresolved, this->SurfaceVersion });
  }
  if (!this->UnlikeEdges.Words().empty())
  {
    warnings.push_back({ this->UnlikeEdges, this->SurfaceVersion });
  }
  if (this->IsInEdges)
  {
    this->AppendLongEdges(warnings);
  }
  AppendMissedResidual(this->MissedResidual, warnings);
  return warnings;
}

} // namespace SurfaceDiffusion
