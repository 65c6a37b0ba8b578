// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/TimeRequests.h"
#include "Distributed/Processes.h"
#include "vtkSurfaceModelAlgorithmInternals.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"

#include <optional>
#include <utility>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkSurfaceDiffusionAlgorithm::vtkSurfaceDiffusionAlgorithm(OwnedSettings settings)
  : Superclass(std::move(settings))
  , KnownLength(std::make_unique<RunLength>())
{
  this->DeclareNumber("TimeUnit", 1.0);
  this->DeclareNumber("NumberOfStepsComputed");
}

vtkSurfaceDiffusionAlgorithm::~vtkSurfaceDiffusionAlgorithm() = default;

TimeSettings& vtkSurfaceDiffusionAlgorithm::GetTimeSettings() const
{
  return static_cast<TimeSettings&>(this->GetSettings());
}

void vtkSurfaceDiffusionAlgorithm::UsePaperScheme()
{
  this->SetIntrinsicDelaunay(false);
  this->SetMaskModeToInpaint();
}

double vtkSurfaceDiffusionAlgorithm::GetEffectiveTimeStep()
{
  return this->GetTimeSettings().DescribeModel().TimeStep;
}

/// Problems of the settings are reported at update, which then has no time.
bool vtkSurfaceDiffusionAlgorithm::PublishesTimes() const
{
  TimeSettings& settings = this->GetTimeSettings();
  Problems problems;
  settings.Check(nullptr, problems);
  return problems.empty() && settings.PublishesTimes();
}

int vtkSurfaceDiffusionAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  if (this->PublishesTimes())
  {
    TimeSettings& settings = this->GetTimeSettings();
    PublishTimes(settings, this->KnownLength->Find(settings), outputs);
  }
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  if (this->PublishesTimes())
  {
    RequestFirstTime(inputs[0]->GetInformationObject(0));
  }
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  UpdateState& state = *this->State;
  state.ChooseStep = nullptr;
  state.TimeWarnings.clear();
  if (!this->PublishesTimes())
  {
    return this->Superclass::RequestData(request, inputs, outputs);
  }
  const std::optional<double> time = FindRequestedTime(request, outputs);
  state.TimeWarnings = DescribeUnusedTimes(inputs[0]->GetInformationObject(0));
  double last = -1.0; // not known, unless the run succeeds in this process
  state.ChooseStep = [&](int found)
  {
    last = found;
    return FindStep(static_cast<const TimeSettings&>(*state.Settings), time, found);
  };
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  state.ChooseStep = nullptr;
  Processes(this->GetController()).Broadcast(&last, 1);
  auto& settings = static_cast<TimeSettings&>(*state.Settings);
  if (last >= 0.0 && this->KnownLength->Set(settings, static_cast<int>(last)))
  {
    PublishTimes(settings, static_cast<int>(last), outputs);
    this->Modified(); // filters downstream, which have not seen these times
  }
  const int step = FindStep(settings, time, this->KnownLength->Find(settings));
  SetDataTime(step * settings.DescribeModel().TimeStep, outputs);
  return result;
}
VTK_ABI_NAMESPACE_END
