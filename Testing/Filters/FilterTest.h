// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFVMHeatFilter.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkTriangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// Small surfaces, and functions that examine results, for the tests of the filters.
namespace FilterTest
{

// --- Surfaces ---

/// A flat rectangle of nx x ny points, all squares split along the same diagonal. Point i + nx j is
/// at (i, j, 0) spacing.
inline vtkSmartPointer<vtkPolyData> Grid(int nx, int ny, double spacing = 1.0)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int j = 0; j < ny; ++j)
  {
    for (int i = 0; i < nx; ++i)
    {
      points->InsertNextPoint(i * spacing, j * spacing, 0.0);
    }
  }
  vtkNew<vtkCellArray> triangles;
  for (int j = 0; j + 1 < ny; ++j)
  {
    for (int i = 0; i + 1 < nx; ++i)
    {
      const vtkIdType a = i + nx * j;
      triangles->InsertNextCell({ a, a + 1, a + nx + 1 });
      triangles->InsertNextCell({ a, a + nx + 1, a + nx });
    }
  }
  auto grid = vtkSmartPointer<vtkPolyData>::New();
  grid->SetPoints(points);
  grid->SetPolys(triangles);
  return grid;
}

/// The unit sphere: an octahedron whose triangles are split into four `levels` times.
inline vtkSmartPointer<vtkPolyData> Sphere(int levels)
{
  using Triangle = std::array<vtkIdType, 3>;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const double sign : { 1.0, -1.0 })
  {
    points->InsertNextPoint(sign, 0.0, 0.0);
    points->InsertNextPoint(0.0, sign, 0.0);
    points->InsertNextPoint(0.0, 0.0, sign);
  }
  std::vector<Triangle> faces;
  for (int octant = 0; octant < 8; ++octant)
  {
    const Triangle face{ octant & 1 ? 3 : 0, octant & 2 ? 4 : 1, octant & 4 ? 5 : 2 };
    const bool flipped = ((octant & 1) + (octant >> 1 & 1) + (octant >> 2 & 1)) % 2;
    faces.push_back(flipped ? Triangle{ face[0], face[2], face[1] } : face);
  }
  for (int level = 0; level < levels; ++level)
  {
    std::map<std::pair<vtkIdType, vtkIdType>, vtkIdType> middles;
    const auto middle = [&](vtkIdType a, vtkIdType b)
    {
      const auto found = middles.emplace(std::minmax(a, b), points->GetNumberOfPoints());
      if (found.second)
      {
        double p[3];
        double q[3];
        points->GetPoint(a, p);
        points->GetPoint(b, q);
        vtkMath::Add(p, q, p);
        vtkMath::Normalize(p);
        points->InsertNextPoint(p);
      }
      return found.first->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& face : faces)
    {
      const vtkIdType a = middle(face[1], face[2]);
      const vtkIdType b = middle(face[2], face[0]);
      const vtkIdType c = middle(face[0], face[1]);
      finer.insert(
        finer.end(), { { face[0], c, b }, { c, face[1], a }, { b, a, face[2] }, { a, b, c } });
    }
    faces.swap(finer);
  }
  vtkNew<vtkCellArray> triangles;
  for (const Triangle& face : faces)
  {
    triangles->InsertNextCell(3, face.data());
  }
  auto sphere = vtkSmartPointer<vtkPolyData>::New();
  sphere->SetPoints(points);
  sphere->SetPolys(triangles);
  return sphere;
}

// --- Arrays ---

/// An array of any VTK type whose component k of tuple i is value(i, k).
template <typename Value>
vtkSmartPointer<vtkDataArray> MakeArray(
  int type, const char* name, vtkIdType tuples, int components, Value&& value)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      array->SetComponent(i, k, value(i, k));
    }
  }
  return array;
}

template <typename Value>
vtkDataArray* AddPointArray(
  vtkPolyData* surface, const char* name, int components, Value&& value, int type = VTK_DOUBLE)
{
  const auto array = MakeArray(type, name, surface->GetNumberOfPoints(), components, value);
  surface->GetPointData()->AddArray(array);
  return array;
}

/// White noise of deviation 1 smoothed with a Gaussian kernel of a standard deviation of `length`,
/// at a place: 200 waves whose wave vectors have its spectrum.
inline double SmoothedNoise(const double* x, double length)
{
  const auto random = [](int wave, int k)
  { return std::fmod(std::abs(std::sin(12.9898 * wave + 78.233 * k + 1.0)) * 43758.5453, 1.0); };
  const double pi = std::acos(-1.0);
  double sum = 0.0;
  for (int wave = 0; wave < 200; ++wave)
  {
    double phase = 2.0 * pi * random(wave, 0);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double gaussian = std::sqrt(-2.0 * std::log(1.0 - random(wave, 2 * axis + 1))) *
        std::cos(2.0 * pi * random(wave, 2 * axis + 2));
      phase += x[axis] * gaussian / (std::sqrt(2.0) * length);
    }
    sum += std::cos(phase);
  }
  return sum / 10.0;
}

/// A function that is smooth nowhere, in [-1, 1), different in each component.
inline double Rough(vtkIdType i, int k)
{
  return std::fmod(static_cast<double>((i + 1) * (7919 + 104 * k) % 1009), 201.0) / 100.5 - 1.0;
}

/// Adds the rough array "f" and makes it active.
inline vtkDataArray* AddRough(vtkPolyData* surface, int components = 1)
{
  vtkDataArray* f = AddPointArray(surface, "f", components, Rough);
  surface->GetPointData()->SetActiveScalars("f");
  return f;
}

inline bool Identical(vtkDataArray* a, vtkDataArray* b)
{
  bool same = a && b && a->GetNumberOfTuples() == b->GetNumberOfTuples() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() && a->GetNumberOfTuples() > 0;
  for (vtkIdType i = 0; same && i < a->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; same && k < a->GetNumberOfComponents(); ++k)
    {
      const double left = a->GetComponent(i, k);
      const double right = b->GetComponent(i, k);
      same = left == right || (std::isnan(left) && std::isnan(right));
    }
  }
  return same;
}

inline double LargestDifference(vtkDataArray* a, vtkDataArray* b)
{
  double largest = a->GetNumberOfTuples() == b->GetNumberOfTuples() ? 0.0 : VTK_DOUBLE_MAX;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < a->GetNumberOfComponents(); ++k)
    {
      const double difference = std::abs(a->GetComponent(i, k) - b->GetComponent(i, k));
      largest = difference <= largest ? largest : difference; // keeps NaN
    }
  }
  return largest;
}

inline bool AllFinite(vtkDataArray* array)
{
  bool finite = array && array->GetNumberOfTuples() > 0;
  for (vtkIdType i = 0; finite && i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; finite && k < array->GetNumberOfComponents(); ++k)
    {
      finite = std::isfinite(array->GetComponent(i, k));
    }
  }
  return finite;
}

/// Barycentric control areas A_i of a surface of triangles.
inline std::vector<double> ControlAreas(vtkPolyData* surface)
{
  std::vector<double> areas(surface->GetNumberOfPoints(), 0.0);
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    surface->GetCellPoints(c, corners);
    double p[3][3];
    for (int a = 0; a < 3; ++a)
    {
      surface->GetPoint(corners->GetId(a), p[a]);
    }
    for (int a = 0; a < 3; ++a)
    {
      areas[corners->GetId(a)] += vtkTriangle::TriangleArea(p[0], p[1], p[2]) / 3.0;
    }
  }
  return areas;
}

/// The sums of A_i u_i and of A_i |u_i|, of component k.
inline double Total(const std::vector<double>& areas, vtkDataArray* u, int k = 0)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
  {
    sum += areas[i] * u->GetComponent(i, k);
  }
  return sum;
}
inline double TotalMagnitude(const std::vector<double>& areas, vtkDataArray* u, int k = 0)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
  {
    sum += areas[i] * std::abs(u->GetComponent(i, k));
  }
  return sum;
}

// --- Filters ---

inline void SetInputArray(vtkAlgorithm* filter, int index, const char* name, bool onCells = false)
{
  filter->SetInputArrayToProcess(index, 0, 0,
    onCells ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
    name);
}

/// The point array of output port 0 with this name, or nullptr.
inline vtkDataArray* Result(vtkPolyDataAlgorithm* filter, const char* name = "fDiffused")
{
  return filter->GetOutput() ? filter->GetOutput()->GetPointData()->GetArray(name) : nullptr;
}

/// A copy that later updates do not change.
inline vtkSmartPointer<vtkDataArray> Copy(vtkDataArray* array)
{
  auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  copy->DeepCopy(array);
  return copy;
}

inline vtkTable* History(vtkAlgorithm* filter)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
}

inline double HistoryAt(vtkAlgorithm* filter, vtkIdType row, const char* column)
{
  return History(filter)->GetValueByName(row, column).ToDouble();
}

/// Requests a time at output port 0.
inline void UpdateAt(vtkAlgorithm* filter, double time)
{
  filter->UpdateInformation();
  filter->GetOutputInformation(0)->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), time);
  filter->Update();
}

inline std::vector<double> PublishedTimes(vtkAlgorithm* filter, int port = 0)
{
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(port);
  vtkInformationDoubleVectorKey* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  const double* times = info->Get(key);
  return times ? std::vector<double>(times, times + info->Length(key)) : std::vector<double>();
}

/// Collects the errors and warnings of an object instead of printing them.
class Messages
{
public:
  explicit Messages(vtkObject* object)
    : Object(object)
  {
    this->Listener->Owner = this;
    this->Tags[0] = object->AddObserver(vtkCommand::ErrorEvent, this->Listener);
    this->Tags[1] = object->AddObserver(vtkCommand::WarningEvent, this->Listener);
  }
  ~Messages()
  {
    this->Object->RemoveObserver(this->Tags[0]);
    this->Object->RemoveObserver(this->Tags[1]);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  std::vector<std::string> Errors, Warnings;

private:
  struct Command : vtkCommand
  {
    static Command* New() { return new Command; }
    void Execute(vtkObject*, unsigned long event, void* text) override
    {
      auto& texts = event == vtkCommand::ErrorEvent ? this->Owner->Errors : this->Owner->Warnings;
      texts.emplace_back(static_cast<const char*>(text));
    }
    Messages* Owner = nullptr;
  };

  vtkSmartPointer<vtkObject> Object;
  vtkNew<Command> Listener;
  unsigned long Tags[2];
};

/// Calls a function at every progress report.
template <typename Function>
class ProgressListener : public vtkCommand
{
public:
  explicit ProgressListener(Function function)
    : OnProgress(function)
  {
  }
  void Execute(vtkObject*, unsigned long, void* amount) override
  {
    this->OnProgress(*static_cast<double*>(amount));
  }

private:
  Function OnProgress;
};

template <typename Function>
unsigned long Listen(vtkAlgorithm* filter, Function function)
{
  auto listener = vtkSmartPointer<vtkCommand>::Take(new ProgressListener<Function>(function));
  return filter->AddObserver(vtkCommand::ProgressEvent, listener);
}

inline vtkSmartPointer<vtkFVMHeatFilter> MakeHeatFilter(vtkPolyData* surface)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputData(surface);
  return filter;
}

/// The first error of an update; empty if there is none.
inline std::string ErrorOf(vtkPolyDataAlgorithm* filter)
{
  const Messages messages(filter);
  filter->Update();
  return messages.Errors.empty() ? "" : messages.Errors[0];
}

} // namespace FilterTest
