// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PointInput.h"

#include "Conversion/FieldReader.h"
#include "Distributed/CellFlags.h"
#include "Distributed/PieceArrays.h"
#include "Distributed/ProcessReduction.h"
#include "Distributed/Processes.h"
#include "Run/Collective.h"
#include "Run/InputSentences.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The array of this name or, without one, the active scalars; null with a problem if there is none.
vtkDataArray* FindArray(
  vtkPointSet* points, const std::string& name, const char* property, Problems& problems)
{
  const bool hasName = !name.empty();
  vtkPointData* const attributes = points->GetPointData();
  vtkAbstractArray* const found =
    hasName ? attributes->GetAbstractArray(name.c_str()) : attributes->GetScalars();
  const std::string label = ArrayLabel(property, name);
  if (!found)
  {
    problems.push_back(Say(hasName ? "NotAmongPoints" : "NoScalarsOfPoints", label));
    return nullptr;
  }
  vtkDataArray* const array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    problems.push_back(Say("Class", label, found->GetClassName()));
  }
  return array;
}

template <typename Matrix>
std::vector<double> Flat(const Matrix& matrix)
{
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

/// Replaces the values of hidden points by NaN, which is no value.
void ForgetHidden(const std::vector<char>& hidden, PointSamples& samples)
{
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    if (hidden[i] != 0)
    {
      const auto row = static_cast<Eigen::Index>(i);
      samples.Places.row(row).setZero();
      samples.Given.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
      if (!samples.Weights.empty())
      {
        samples.Weights[i] = 0.0;
      }
    }
  }
}

/// The points of all processes, in every process.
void Gather(const Processes& processes, PointSamples& samples)
{
  const std::vector<double> places = processes.GatherAll(Flat(samples.Places));
  const std::vector<double> values = processes.GatherAll(Flat(samples.Given));
  samples.Weights = processes.GatherAll(samples.Weights);
  const auto count = static_cast<Eigen::Index>(places.size() / 3);
  samples.Places = Eigen::Map<const Points>(places.data(), count, 3);
  const auto columns =
    count > 0 ? static_cast<Eigen::Index>(values.size()) / count : samples.Given.cols();
  samples.Given = Eigen::Map<const Values>(values.data(), count, columns);
}

} // namespace

void DescribePointPort(vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
}

vtkDataObject* FindOptionalInput(vtkInformationVector** inputs, int port)
{
  return inputs[port]->GetNumberOfInformationObjects() > 0 ? vtkDataObject::GetData(inputs[port])
                                                           : nullptr;
}

Points ReadPlaces(vtkPointSet* points)
{
  Points places(points->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    points->GetPoint(i, places.row(i).data());
  }
  return places;
}

std::shared_ptr<const PointSamples> ReadPointSamples(vtkDataObject* data,
  const PointInputNames& names, vtkMultiProcessController* controller, Problems& problems)
{
  const Processes processes(controller);
  auto samples = std::make_shared<PointSamples>();
  samples->Places.resize(0, 3);
  vtkPointSet* const points = vtkPointSet::SafeDownCast(data);
  const std::size_t before = problems.size();
  const std::vector<char> hidden = points ? FindHiddenPoints(points) : std::vector<char>();
  const bool hasVisible = points &&
    points->GetNumberOfPoints() > std::count(hidden.begin(), hidden.end(), static_cast<char>(1));
  const bool isEmpty = !processes.Any(hasVisible);
  std::vector<SharedArray> arrays;
  if (!points)
  {
    problems.push_back(Say("NoPointSet", "the points with values are", data->GetClassName()));
  }
  else if (isEmpty)
  {
    problems.push_back(Say(hidden.empty() ? "NoPoints" : "HiddenPoints",
      "the second input, the points with values", hidden.size(), ""));
  }
  // A process without points need not have the arrays of the others.
  else if (points->GetNumberOfPoints() > 0)
  {
    vtkDataArray* const values = FindArray(points, names.Values, "PointValueArray", problems);
    vtkDataArray* const weights = names.Weights.empty()
      ? nullptr
      : FindArray(points, names.Weights, "PointWeightArray", problems);
    if (weights && weights->GetNumberOfComponents() != 1)
    {
      problems.push_back(
        Say("Components", "PointWeightArray", weights->GetNumberOfComponents(), 1));
    }
    if (values && problems.size() == before)
    {
      arrays.push_back(DescribeArray("values", values, false));
      const vtkIdType count = points->GetNumberOfPoints();
      samples->Name = values->GetName() ? values->GetName() : "";
      samples->Given = ReadValues(values);
      samples->Places = ReadPlaces(points);
      for (vtkIdType i = 0; weights && i < count; ++i)
      {
        samples->Weights.push_back(weights->GetComponent(i, 0));
      }
      ForgetHidden(hidden, *samples);
    }
  }
  const std::string disagreement = FindDisagreement(processes, arrays);
  if (!disagreement.empty())
  {
    problems.emplace_back(disagreement);
  }
  // Process 0 reports for all, and may compute alone.
  const std::string problem = FirstMessage(ProcessReduction(controller), Join(problems).Text());
  if (!problem.empty())
  {
    if (problems.size() == before)
    {
      problems.emplace_back(problem);
    }
    return nullptr;
  }
  if (processes.Count() > 1)
  {
    for (const std::vector<char>& name :
      processes.GatherPerProcess(std::vector<char>(samples->Name.begin(), samples->Name.end())))
    {
      samples->Name = name.empty() ? samples->Name : std::string(name.begin(), name.end());
    }
    Gather(processes, *samples);
  }
  return samples;
}

void AddSamples(Fingerprint& fingerprint, const PointSamples& samples)
{
  const auto add = [&](const double* numbers, std::size_t count)
  {
    fingerprint.AddNumber(std::uint64_t{ count });
    fingerprint.AddBytes(numbers, count * sizeof(double), SerialFor());
  };
  add(samples.Places.data(), static_cast<std::size_t>(samples.Places.size()));
  add(samples.Given.data(), static_cast<std::size_t>(samples.Given.size()));
  add(samples.Weights.data(), samples.Weights.size());
  fingerprint.AddBytes(samples.Name.data(), samples.Name.size(), SerialFor());
}

} // namespace SurfaceDiffusion
