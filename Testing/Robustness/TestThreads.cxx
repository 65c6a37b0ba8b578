// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AllFilters.h"

#include "vtkSMPTools.h"

#include <thread>

using namespace FilterTest;

namespace
{

class AnyThreads : public testing::TestWithParam<FilterKind>
{
protected:
  AnyThreads() { AddRough(this->Surface); }
  ~AnyThreads() override
  {
    vtkSMPTools::SetBackend(this->Before.c_str());
    vtkSMPTools::Initialize(0);
  }

  /// The result on a copy of the surface.
  vtkSmartPointer<vtkDataArray> Run()
  {
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(this->Surface);
    auto filter = this->GetParam().Make();
    filter->SetInputData(copy);
    filter->Update();
    return ResultOf(filter, this->GetParam().Result);
  }

  const std::string Before = vtkSMPTools::GetBackend();
  vtkSmartPointer<vtkPolyData> Surface = Sphere(6); // 16386 points, 32768 triangles
};

} // namespace

TEST_P(AnyThreads, DoNotChangeABit)
{
  vtkSMPTools::SetBackend("Sequential");
  const vtkSmartPointer<vtkDataArray> alone = this->Run();
  for (const char* backend : { "STDThread", "TBB", "OpenMP" })
  {
    if (!vtkSMPTools::SetBackend(backend)) // VTK was built without
    {
      continue;
    }
    for (const int threads : { 1, 2, 4 })
    {
      vtkSMPTools::Initialize(threads);
      EXPECT_TRUE(Identical(alone, this->Run())) << backend << ' ' << threads;
    }
  }
}

TEST_P(AnyThreads, MayRunTwoFiltersAtOnce)
{
  const vtkSmartPointer<vtkDataArray> alone = this->Run();
  vtkSmartPointer<vtkDataArray> results[2];
  std::thread threads[2];
  for (int i = 0; i < 2; ++i)
  {
    threads[i] = std::thread([&, i] { results[i] = this->Run(); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_TRUE(Identical(alone, results[0]));
  EXPECT_TRUE(Identical(alone, results[1]));
}

INSTANTIATE_TEST_SUITE_P(Threads, AnyThreads, testing::ValuesIn(AllFilters()), KindName);
