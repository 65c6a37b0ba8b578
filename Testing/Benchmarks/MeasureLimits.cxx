// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The response time to an abort and the memory of a run, for every filter on a torus of a million
// vertices (or of the square of the first argument; the second one names the only run to measure):
// the longest time between two checks for an abort, the progress at which it occurred, and the peak
// memory per vertex in addition to the input. If other work runs on the machine, the CPU time of
// all threads between two checks is more reliable than the elapsed time.

#include "Meshes.h"
#include "ProcessTime.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <malloc.h>
#include <string>

using namespace SurfaceDiffusion;

namespace
{

using Clock = std::chrono::steady_clock;

/// The value of a line of /proc/self/status in bytes.
double Memory(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.compare(0, name.size(), name) == 0)
    {
      return 1024.0 * std::strtod(line.c_str() + name.size() + 1, nullptr);
    }
  }
  return 0.0;
}

vtkSmartPointer<vtkPolyData> MakeInput(Index around)
{
  const Testing::Surface torus = Testing::Torus(around, around);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> f;
  f->SetName("f");
  for (Index i = 0; i < torus.NumberOfVertices(); ++i)
  {
    points->InsertNextPoint(torus.Vertices.row(i).data());
    f->InsertNextValue(UniformRandom(1, 0, i));
  }
  vtkNew<vtkCellArray> cells;
  for (Index t = 0; t < torus.NumberOfTriangles(); ++t)
  {
    cells->InsertNextCell({ torus.Faces(t, 0), torus.Faces(t, 1), torus.Faces(t, 2) });
  }
  auto input = vtkSmartPointer<vtkPolyData>::New();
  input->SetPoints(points);
  input->SetPolys(cells);
  input->GetPointData()->SetScalars(f);
  return input;
}

/// Measures the longest time between two reports of progress.
struct Watch
{
  Clock::time_point Last = Clock::now();
  double LastOfProcess = Testing::Now();
  double LastAmount = 0.0;
  double Longest = 0.0;
  double Where = 0.0; ///< progress at the start of the longest interval
  double LongestOfProcess = 0.0; ///< longest interval in CPU time

  void Report(double amount)
  {
    const Clock::time_point now = Clock::now();
    const double silence = std::chrono::duration<double>(now - this->Last).count();
    // An abort has no effect once everything is computed.
    if (silence > this->Longest && amount < 1.0)
    {
      this->Longest = silence;
      this->Where = this->LastAmount;
    }
    const double ofProcess = Testing::Now();
    if (amount < 1.0)
    {
      this->LongestOfProcess = std::max(this->LongestOfProcess, ofProcess - this->LastOfProcess);
    }
    this->Last = now;
    this->LastOfProcess = ofProcess;
    this->LastAmount = amount;
  }
};

/// The only run to measure, or none to measure all.
std::string OnlyRun;

void Measure(const char* name, vtkPolyData* input, vtkPolyDataAlgorithm* filter)
{
  if (!OnlyRun.empty() && OnlyRun != name)
  {
    return;
  }
  Watch watch;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watch);
  command->SetCallback([](vtkObject*, unsigned long, void* client, void* amount)
    { static_cast<Watch*>(client)->Report(*static_cast<double*>(amount)); });
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->SetInputData(input);
  malloc_trim(0); // returns the memory that the last run freed
  std::ofstream("/proc/self/clear_refs") << 5; // resets the peak
  const double before = Memory("VmRSS:");
  const Clock::time_point start = Clock::now();
  watch.Last = start;
  watch.LastOfProcess = Testing::Now();
  filter->Update();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::printf("%-24s %7.2f s   silent %6.3f s at most (%.3f s of CPU), after progress %.3f   "
              "%6.0f bytes/vertex\n",
    name, seconds, watch.Longest, watch.LongestOfProcess, watch.Where,
    (Memory("VmHWM:") - before) / static_cast<double>(input->GetNumberOfPoints()));
  std::fflush(stdout);
}

template <typename Filter>
void MeasureWith(const char* name, vtkPolyData* input, const std::function<void(Filter*)>& set)
{
  vtkNew<Filter> filter;
  set(filter);
  Measure(name, input, filter);
}

} // namespace

int main(int argc, char** argv)
{
  OnlyRun = argc > 2 ? argv[2] : "";
  const auto input = MakeInput(argc > 1 ? std::atoi(argv[1]) : 1000);
  using Heat = vtkFVMHeatFilter;
  using TV = vtkIntrinsicTVFilter;
  using Harmonic = vtkHarmonicMapFilter;
  using Turing = vtkTuringTextureFilter;
  using Field = vtkSurfaceDirectionFieldFilter;
  MeasureWith<Heat>("Heat, gradients", input, [](Heat* f) { f->SetSolverToConjugateGradient(); });
  MeasureWith<Heat>("Heat, Delaunay", input,
    [](Heat* f)
    {
      f->IntrinsicDelaunayOn();
      f->SetSolverToConjugateGradient();
    });
  MeasureWith<TV>("TV", input, [](TV* f) { f->SetNumberOfTimeSteps(3); });
  MeasureWith<TV>("TV, minimiser", input,
    [](TV* f)
    {
      f->SetModeToSteadyState();
      f->SetStopTolerance(0.1);
    });
  MeasureWith<TV>("TV, Crouzeix-Raviart", input,
    [](TV* f)
    {
      f->SetDiscretizationToCrouzeixRaviart();
      f->SetNumberOfTimeSteps(2);
    });
  MeasureWith<Harmonic>("Harmonic map", input,
    [](Harmonic* f)
    {
      f->SetNumberOfTimeSteps(2);
      f->SetSolverToConjugateGradient();
    });
  MeasureWith<Turing>("Turing", input,
    [](Turing* f)
    {
      f->SetNumberOfTimeSteps(5);
      f->SetSolverToConjugateGradient();
    });
  MeasureWith<Field>("Principal curvature", input, [](Field*) {});
  MeasureWith<Heat>("Heat, factor", input, [](Heat* f) { f->SetSolverToDirect(); }); // slow
  return 0;
}
