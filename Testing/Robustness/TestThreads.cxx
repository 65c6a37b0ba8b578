// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AllFilters.h"
#include "Conversion/SMPParallelFor.h"

#include "vtkSMPTools.h"

#include <cmath>
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

  /// The result on a copy of the surface.
  vtkSmartPointer<vtkDataArray> Run(vtkPolyData* surface)
  {
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(surface);
    auto filter = this->GetParam().Make();
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
  vtkSMPTools::SetBackend("Sequential");
  const vtkSmartPointer<vtkDataArray> alone = this->Run(surface);
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
