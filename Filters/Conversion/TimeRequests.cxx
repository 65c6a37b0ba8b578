// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/TimeRequests.h"

#include "Run/InputSentences.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>

namespace SurfaceDiffusion
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

void PublishTimes(const TimeSettings& settings, int last, vtkInformationVector* outputs)
{
  const std::vector<double> times = settings.PublishedTimes(last);
  const double range[2] = { times.front(), times.back() };
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* const info = outputs->GetInformationObject(port);
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}

namespace
{

/// The first and the last time; none if the data have no times.
std::optional<std::array<double, 2>> FindTimes(vtkInformation* input)
{
  const int steps = input->Has(Pipeline::TIME_STEPS()) ? input->Length(Pipeline::TIME_STEPS()) : 0;
  if (steps > 0)
  {
    const double* const times = input->Get(Pipeline::TIME_STEPS());
    return { { times[0], times[steps - 1] } };
  }
  if (input->Has(Pipeline::TIME_RANGE()))
  {
    const double* const range = input->Get(Pipeline::TIME_RANGE());
    return { { range[0], range[1] } };
  }
  return std::nullopt;
}

} // namespace

void RequestFirstTime(vtkInformation* input)
{
  if (const auto times = FindTimes(input))
  {
    input->Set(Pipeline::UPDATE_TIME_STEP(), times->front());
  }
  else
  {
    input->Remove(Pipeline::UPDATE_TIME_STEP());
  }
}

std::vector<Sentence> DescribeUnusedTimes(vtkInformation* input)
{
  const auto times = FindTimes(input);
  if (!times || times->front() == times->back())
  {
    return {};
  }
  return { Say("Times", times->front(), times->back(), times->front()) };
}

std::optional<double> FindRequestedTime(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = request->Has(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT())
    ? std::max(0, request->Get(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT()))
    : 0;
  vtkInformation* const info = outputs->GetInformationObject(port);
  if (info->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    return info->Get(Pipeline::UPDATE_TIME_STEP());
  }
  return std::nullopt;
}

int FindStep(const TimeSettings& settings, const std::optional<double>& time, int last)
{
  return time ? settings.FindStep(*time, last) : last;
}

void SetDataTime(double time, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(outputs, port)
      ->GetInformation()
      ->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
}

int RunLength::Find(TimeSettings& settings) const
{
  const int steps = settings.DescribeModel().NumberOfSteps;
  const bool isKnown = this->NumberOfSteps == steps &&
    this->Surface == SettingsSnapshot(settings, SettingScope::Surface) &&
    this->Model == SettingsSnapshot(settings, SettingScope::Model);
  return isKnown ? this->LastStep : steps;
}

bool RunLength::Set(TimeSettings& settings, int last)
{
  const bool isNew = this->Find(settings) != last;
  this->Surface = SettingsSnapshot(settings, SettingScope::Surface);
  this->Model = SettingsSnapshot(settings, SettingScope::Model);
  this->NumberOfSteps = settings.DescribeModel().NumberOfSteps;
  this->LastStep = last;
  return isNew;
}

} // namespace SurfaceDiffusion
