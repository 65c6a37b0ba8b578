// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "AllFilters.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/ThreadScope.h"
#include "Core/Foundation/ProgressMonitor.h"

#include "vtkDoubleArray.h"
#include "vtkFVMHeatFilter.h"
#include "vtkSMPTools.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <utility>

#ifdef __linux__
#include <sys/wait.h>
#include <unistd.h>
#endif

using namespace FilterTest;
using SurfaceDiffusion::BlockSize;

namespace
{

#ifdef __SANITIZE_THREAD__
constexpr bool IsSanitized = true; // which takes 10 to 60 times as long
#else
constexpr bool IsSanitized = false;
#endif

/// A surface of n x n points. With the default, it is large enough for loops over its points to run on
/// several threads.
vtkSmartPointer<vtkPolyData> Hills(int n = 224)
{
  auto hills = Grid(n, n);
  vtkPoints* points = hills->GetPoints();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    points->SetPoint(i, x[0], x[1], 8.0 * std::sin(0.1 * x[0]) * std::cos(0.13 * x[1]));
  }
  AddRough(hills);
  AddArraysOfAllFilters(hills);
  return hills;
}

/// Whether all loops over more than one block run on several threads.
struct ThreadsForAll : vtkSurfaceFilter
{
  ThreadsForAll() = delete;
  static void Set(bool all) { ShareLoopsFrom(all ? 2 : Usual); }
  static constexpr int Usual = 24;
};

class AnyThreads : public testing::TestWithParam<FilterKind>
{
protected:
  ~AnyThreads() override
  {
    vtkSMPTools::SetBackend(this->Before.c_str());
    vtkSMPTools::Initialize(0);
    ThreadsForAll::Set(false);
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
  const FilterKind& kind = this->GetParam();
  ThreadsForAll::Set(true);
  const vtkSmartPointer<vtkPolyData> surface =
    Hills(kind.IsSlow ? 48 : 96); // 2 and 5 blocks of points
  EXPECT_GE(surface->GetNumberOfPoints(), BlockSize + 1);
  if (IsSanitized) // one run has all the accesses that may race, and the others would take hours
  {
    vtkSMPTools::SetBackend("STDThread");
    vtkSMPTools::Initialize(4);
    EXPECT_NE(this->Run(surface), nullptr);
    return;
  }
  vtkSMPTools::SetBackend("Sequential");
  const vtkSmartPointer<vtkDataArray> alone = this->Run(surface);
  const std::pair<const char*, int> runs[] = { { "STDThread", 2 }, { "TBB", 0 }, { "OpenMP", 0 } };
  for (const auto& [backend, threads] : runs)
  {
    if (!vtkSMPTools::SetBackend(backend)) // VTK was built without this backend
    {
      continue;
    }
    vtkSMPTools::Initialize(4);
    EXPECT_TRUE(Identical(alone, this->Run(surface, threads))) << backend;
  }
}

namespace
{

/// Whether two tasks of a loop run at the same time. Each waits this long for the other.
bool RunsTwoTasksAtOnce(std::chrono::milliseconds patience)
{
  std::atomic<int> active{ 0 };
  std::atomic<bool> together{ false };
  SurfaceDiffusion::SMPParallelFor::Instance().RunTasks(2,
    [&](SurfaceDiffusion::Index begin, SurfaceDiffusion::Index end)
    {
      ++active;
      const auto start = std::chrono::steady_clock::now();
      while (!together && end - begin == 1 && std::chrono::steady_clock::now() - start < patience)
      {
        if (active == 2) // never set back to false: the other task may have found it at this moment
        {
          together = true;
        }
      }
      --active;
    });
  return together;
}

/// Whether an update has threads if they may be at most this number; 0: all.
bool HasThreads(int number, bool severalProcesses = false)
{
  const SurfaceDiffusion::ThreadScope scope(number, severalProcesses);
  return RunsTwoTasksAtOnce(std::chrono::seconds(20)); // on a loaded machine
}

/// The same of a task on another thread, as that which builds a large surface.
bool HasThreadsInBackground(int number, std::chrono::milliseconds patience)
{
  const SurfaceDiffusion::ThreadScope scope(number, false);
  bool found = false;
  SurfaceDiffusion::RunInBackground(SurfaceDiffusion::SMPParallelFor::Instance().ForOtherThread(
                                      [&] { found = RunsTwoTasksAtOnce(patience); }),
    SurfaceDiffusion::ProgressMonitor());
  return found;
}

bool IsAlone(int number, bool severalProcesses = false)
{
  const SurfaceDiffusion::ThreadScope scope(number, severalProcesses);
  return !RunsTwoTasksAtOnce(std::chrono::milliseconds(300));
}

/// Ends a program in which VTK has its default and the user has chosen nothing before `choose`:
/// with 0 if the check holds.
void ExpectInNewProgram(const std::function<void()>& choose, const std::function<bool()>& check)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
    {
      unsetenv("VTK_SMP_BACKEND_IN_USE");
      unsetenv("VTK_SMP_MAX_THREADS");
      choose();
      std::exit(check() ? 0 : 1);
    },
    testing::ExitedWithCode(0), "");
}

bool IsSequentialByDefault()
{
  return VTK_SMP_DEFAULT_IMPLEMENTATION_SEQUENTIAL != 0 && std::thread::hardware_concurrency() > 1;
}

} // namespace

TEST(Threads, AreTheFiltersOwnWhereVTKIsSequentialByDefault)
{
  if (!IsSequentialByDefault())
  {
    GTEST_SKIP() << "VTK has another back end by default, or there is one processor";
  }
  const auto nothing = [] {};
  ExpectInNewProgram(nothing, [] { return HasThreads(0) && HasThreads(2) && IsAlone(1); });
  ExpectInNewProgram(nothing, [] { return IsAlone(0, true) && HasThreads(2, true); });
  ExpectInNewProgram(
    nothing, [] { return HasThreads(0) && !RunsTwoTasksAtOnce(std::chrono::milliseconds(300)); });
}

TEST(Threads, AreTheFiltersOwnInTheBackgroundToo)
{
  if (!IsSequentialByDefault())
  {
    GTEST_SKIP() << "VTK has another back end by default, or there is one processor";
  }
  ExpectInNewProgram([] {},
    []
    {
      return HasThreadsInBackground(0, std::chrono::seconds(20)) &&
        !HasThreadsInBackground(1, std::chrono::milliseconds(300));
    });
}

TEST(Threads, AreThoseThatTheUserHasChosen)
{
  if (!IsSequentialByDefault())
  {
    GTEST_SKIP() << "VTK has another back end by default, or there is one processor";
  }
  ExpectInNewProgram(
    [] { setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1); }, [] { return IsAlone(0); });
  ExpectInNewProgram([] { vtkSMPTools::Initialize(1); }, [] { return IsAlone(0); });
  ExpectInNewProgram([] {},
    []
    {
      bool limited = false;
      vtkSMPTools::LocalScope(vtkSMPTools::Config{ 1 }, [&] { limited = IsAlone(0); });
      return limited && HasThreads(0);
    });
  ExpectInNewProgram(
    []
    {
      vtkSMPTools::SetBackend("STDThread");
      HasThreads(0);
      vtkSMPTools::SetBackend("Sequential");
    },
    [] { return IsAlone(0); });
}

TEST(Threads, OfFiltersLeaveThoseOfOtherThreadsAlone)
{
  const std::string before = vtkSMPTools::GetBackend();
  const vtkSmartPointer<vtkPolyData> surface = Hills();
  std::atomic<bool> done{ false };
  std::set<std::string> backEnds;
  int ranges = 0;
  int wrong = 0;
  std::thread other( // vtkDataArray stores the ranges of its parts per thread
    [&]
    {
      vtkNew<vtkDoubleArray> array;
      array->SetNumberOfValues(100000);
      array->FillValue(0.0);
      while (!done)
      {
        ++ranges;
        array->SetValue(ranges % 100000, ranges);
        array->Modified();
        wrong += array->GetRange(0)[1] == ranges ? 0 : 1;
        backEnds.insert(vtkSMPTools::GetBackend());
      }
    });
  for (int update = 0; update < 10; ++update)
  {
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputData(surface);
    filter->Update();
  }
  done = true;
  other.join();
  EXPECT_GT(ranges, 10);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(backEnds, std::set<std::string>{ before });
}

#ifdef __linux__
TEST(Threads, EndWithTheUpdate)
{
  const auto count = []
  {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const vtkSmartPointer<vtkPolyData> surface = Hills();
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(surface);
  filter->SetNumberOfThreads(2);
  const auto before = count();
  filter->Update();
  EXPECT_EQ(count(), before);
  const pid_t child = fork(); // has no threads but this one, and ends all the same
  if (child == 0)
  {
    alarm(20);
    filter->SetTimeStep(2.0);
    filter->Update();
    std::exit(filter->GetErrorCode() == 0 ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}
#endif

TEST_P(AnyThreads, MayRunTwoFiltersAtOnce)
{
  const vtkSmartPointer<vtkPolyData> surface = Sphere(this->GetParam().Levels(5));
  AddRough(surface);
  AddArraysOfAllFilters(surface);
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
