// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DistanceRun.h"

namespace SurfaceDiffusion
{

void DistanceSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "Method", "",
                   "Automatic: Exact where it takes at most a second, without speeds and start "
                   "times, and Eikonal otherwise. Exact: the lengths of the shortest ways over the "
                   "triangles. Eikonal: fast marching, fast on large surfaces; also with speeds "
                   "and start times. Heat: the heat method, with smooth level sets.",
                   "Method=Heat or Method=Exact or (!SpeedArray and !AlongSpeedArray and "
                   "!AcrossSpeedArray and !SourceTimes)" },
    this->Method, { "Heat", "Eikonal", "Exact", "Automatic" });
  visitor.Number({ "MaximumDistance", "coordinates",
                   "The largest distance of points and lines of sources from the surface, in the "
                   "unit of the coordinates: those farther away do not count. 0: any distance." },
    this->MaximumDistance, SettingRange::NonNegative());
  visitor.Number({ "AlongSpeed", "",
                   "Factor of the speed of fronts along the direction, above 0, beside that of "
                   "AlongSpeedArray. If it differs from AcrossSpeed, DirectionArray is required.",
                   "(DirectionArray and (Method=Eikonal or Method=Automatic)) or AlongSpeed!=1" },
    this->AlongSpeed, SettingRange::Positive());
  visitor.Number({ "AcrossSpeed", "",
                   "Factor of the speed of fronts across the direction, above 0, beside that of "
                   "AcrossSpeedArray.",
                   "(DirectionArray and (Method=Eikonal or Method=Automatic)) or AcrossSpeed!=1" },
    this->AcrossSpeed, SettingRange::Positive());
  visitor.Switch({ "ComputeGradient", "",
                   "On: the gradient of the result is added, vectors in the tangent planes that "
                   "point away from the sources." },
    this->ComputeGradient);
  visitor.Switch(
    { "Signed", "",
      "On: the distance is that to the boundary of the region of the sources, between "
      "them and the points around it, and below 0 within. To closed lines it is below 0 on the "
      "smaller side.",
      "!SpeedArray and !AlongSpeedArray and !AcrossSpeedArray and !SourceTimes" },
    this->Signed);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void DistanceSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  if (!fields)
  {
    return;
  }
  if (!fields->Data && !fields->Sources)
  {
    problems.push_back(Sentence(Word::Array("SourceArray"))
      << " is not set; allowed: an array on points, whose nonzero points are the sources, or "
         "sources as a second input");
  }
  const auto requireFronts = [&](bool has, const Sentence& purpose)
  {
    const bool isAllowed =
      this->Method == DistanceMethod::Eikonal || this->Method == DistanceMethod::Automatic;
    Require(!has || isAllowed, Sentence(Word::Setting("Method")),
      Word::Number("Method", this->Method),
      Sentence(Word::NumberedChoice("Method", DistanceMethod::Eikonal, "Eikonal"))
        << " or " << Word::NumberedChoice("Method", DistanceMethod::Automatic, "Automatic")
        << " together with " << purpose,
      problems);
  };
  requireFronts(fields->Speeds, Sentence(Word::Array("SpeedArray")));
  for (const auto& [has, name] : { std::pair(fields->AlongSpeeds, "AlongSpeedArray"),
         std::pair(fields->AcrossSpeeds, "AcrossSpeedArray") })
  {
    requireFronts(has, Sentence(Word::Array(name)));
    if (has && !fields->Directions)
    {
      problems.push_back(Sentence(Word::Array(name))
        << " is set but " << Word::Array("DirectionArray")
        << " is not; allowed: together with an array of directions");
    }
  }
  requireFronts(fields->StartTimes, Sentence(Word::Array("SourceTimes")));
  requireFronts(this->HasSpeed(),
    Sentence(Word::Setting("AlongSpeed"))
      << " " << this->AlongSpeed << " and " << Word::Setting("AcrossSpeed") << " "
      << this->AcrossSpeed);
  const bool areTimes = fields->Speeds || fields->AlongSpeeds || fields->AcrossSpeeds ||
    fields->StartTimes || this->HasSpeed();
  Require(!this->Signed || !areTimes, Sentence(Word::Setting("Signed")),
    Word::SwitchNumber(this->Signed),
    Sentence(Word::SwitchNumber(false)) << " together with speeds and start times", problems);
  if (fields->PathPoints && areTimes)
  {
    problems.push_back(
      Sentence("the path points are set together with speeds or start times; "
               "allowed: path points with distances, whose paths are the shortest"));
  }
  RequireDirections(
    *fields, "AlongSpeed", this->AlongSpeed, "AcrossSpeed", this->AcrossSpeed, problems);
}

} // namespace SurfaceDiffusion
