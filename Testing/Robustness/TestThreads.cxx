// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AllFilters.h"
#include "Conversion/SMPParallelFor.h"

#include "vtkCallbackCommand.h"
#include "vtkFVMHeatFilter.h"
#include "vtkSMPTools.h"

#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <thread>

using namespace FilterTest;
using SurfaceDiffusion::BlockSize;

namespace
{

/// A surface large enough for loops over its points to run on several threads.
vtkSmartPointer<vtkPolyData> Hills()
{
  auto hills = Grid(224, 224);
  vtkPoints* points = hills->GetPoints();
  EXPECT_GE(
    points->GetNumberOfPoints(), vtkIdType(SurfaceDiffusion::SMPParallelFor::Few) * BlockSize);
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    points->SetPoint(i, x[0], x[1], 8.0 * std::sin(0.1 * x[0]) * std::cos(0.13 * x[1]));
  }
  AddRough(hills);
  AddRoughCells(hills);
  return hills;
}

class AnyThreads : public testing::TestWithParam<FilterKind>
{
protected:
  ~AnyThreads() override
  {
    vtkSMPTools::SetBackend(this->Before.c_str());
    vtkSMPTools::Initialize(0);
  }

  /// The result on a copy of the surface, with at most this number of threads; 0: all.
  vtkSmartPointer<vtkDataArray> Run(vtkPolyData* surface, int threads = 0)
  {
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(surface);
    auto filter = this->GetParam().Make();
    vtkSurfaceFilter::SafeDownCast(filter)->SetNumberOfThreads(threads);
    filter->SetInputData(copy);
    filter->Update();
    return ResultOf(filter, this->GetParam().Result);
  }

  const std::string Before = vtkSMPTools::GetBackend();
};

} // namespace

TEST_P(AnyThreads, DoNotChangeABit)
{
  const vtkSmartPointer<vtkPolyData> surface = Hills();
  const vtkSmartPointer<vtkDataArray> alone = this->Run(surface, 1);
  vtkSMPTools::SetBackend("Sequential");
  EXPECT_TRUE(Identical(alone, this->Run(surface)));
  for (const char* backend : { "STDThread", "TBB", "OpenMP" })
  {
    if (!vtkSMPTools::SetBackend(backend)) // VTK was built without this backend
    {
      continue;
    }
    for (const int threads : { 2, 4 })
    {
      vtkSMPTools::Initialize(threads);
      EXPECT_TRUE(Identical(alone, this->Run(surface))) << backend << ' ' << threads;
    }
  }
}

namespace
{

/// VTK's back ends during an update of a filter, and after it.
std::set<std::string> BackEndsOfAnUpdate(int numberOfThreads)
{
  vtkNew<vtkFVMHeatFilter> filter;
  const vtkSmartPointer<vtkPolyData> sphere = Sphere(2);
  AddRough(sphere);
  filter->SetInputData(sphere);
  filter->SetNumberOfThreads(numberOfThreads);
  std::set<std::string> backEnds;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&backEnds);
  observer->SetCallback([](vtkObject*, unsigned long, void* data, void*)
    { static_cast<std::set<std::string>*>(data)->insert(vtkSMPTools::GetBackend()); });
  filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  EXPECT_STREQ(vtkSMPTools::GetBackend(), "Sequential");
  return backEnds;
}

} // namespace

TEST(Threads, ReplaceVTKsSequentialBackEndDuringAnUpdate)
{
  const std::string before = vtkSMPTools::GetBackend();
  const char* const variable = "VTK_SMP_BACKEND_IN_USE";
  const char* const chosen = std::getenv(variable);
  const std::string ofUser = chosen ? chosen : "";
  unsetenv(variable);
  vtkSMPTools::SetBackend("Sequential");
  EXPECT_EQ(BackEndsOfAnUpdate(0).count("STDThread"), 1u);
  EXPECT_EQ(BackEndsOfAnUpdate(2).count("STDThread"), 1u);
  EXPECT_EQ(BackEndsOfAnUpdate(1).count("STDThread"), 0u);
  setenv(variable, "Sequential", 1);
  EXPECT_EQ(BackEndsOfAnUpdate(0).count("STDThread"), 0u);
  chosen ? setenv(variable, ofUser.c_str(), 1) : unsetenv(variable);
  vtkSMPTools::SetBackend(before.c_str());
}

TEST(Threads, OfNegativeNumberAreAnError)
{
  const vtkSmartPointer<vtkPolyData> sphere = Sphere(2);
  AddRough(sphere);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(sphere);
  filter->SetNumberOfThreads(-1);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("NumberOfThreads is -1"), std::string::npos)
    << messages.Errors[0];
}

TEST_P(AnyThreads, MayRunTwoFiltersAtOnce)
{
  const vtkSmartPointer<vtkPolyData> surface = Sphere(6);
  AddRough(surface);
  AddRoughCells(surface);
  const vtkSmartPointer<vtkDataArray> alone = this->Run(surface);
  vtkSmartPointer<vtkDataArray> results[2];
  std::thread threads[2];
  for (int i = 0; i < 2; ++i)
  {
    threads[i] = std::thread([&, i] { results[i] = this->Run(surface); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_TRUE(Identical(alone, results[0]));
  EXPECT_TRUE(Identical(alone, results[1]));
}

INSTANTIATE_TEST_SUITE_P(Threads, AnyThreads, testing::ValuesIn(AllFilters()), KindName);
