// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs that end early: memory runs out at any allocation, the user aborts at any progress report,
// or a solver does not converge. The output is the unchanged input, failures are errors and aborts
// are not, and the next update works.

#include "AllFilters.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>

// operator new and Eigen both allocate with malloc, which sanitizers replace.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SURFACEDIFFUSION_FAIL_ALLOCATIONS
namespace
{
/// Allocations of at least this size are arrays of the mesh; smaller ones are VTK's objects and
/// messages.
constexpr std::size_t Large = 4096;
std::atomic<bool> Armed{ false };
std::atomic<long> LargeBlocksLeft{ 0 };

bool Fails(std::size_t size)
{
  return size >= Large && Armed && LargeBlocksLeft.fetch_sub(1) == 1;
}
}
extern "C"
{
  void* __libc_malloc(std::size_t size);
  void* __libc_realloc(void* block, std::size_t size);
  void* malloc(std::size_t size)
  {
    return Fails(size) ? nullptr : __libc_malloc(size);
  }
  void* realloc(void* block, std::size_t size)
  {
    return Fails(size) ? nullptr : __libc_realloc(block, size);
  }
}
#endif

using namespace FilterTest;

namespace
{

class EveryFilter : public testing::TestWithParam<FilterKind>
{
protected:
  EveryFilter()
  {
    AddRough(this->Surface);
    AddArraysOfAllFilters(this->Surface);
    this->Reference = this->GetParam().Make();
    this->Reference->SetInputData(this->Surface);
    this->Reference->Update();
  }

  vtkDataArray* ResultIn(vtkPolyDataAlgorithm* filter)
  {
    return ResultOf(filter, this->GetParam().Result);
  }

  /// The next update of a filter whose last one ended early gives the result.
  void ExpectWorksNow(vtkPolyDataAlgorithm* filter)
  {
    filter->AbortExecuteOff();
    filter->Modified();
    filter->Update();
    EXPECT_TRUE(Identical(this->ResultIn(filter), this->ResultIn(this->Reference)));
  }

  vtkSmartPointer<vtkPolyData> Surface = Sphere(this->GetParam().Levels(4));
  vtkSmartPointer<vtkPolyDataAlgorithm> Reference;
};

} // namespace

TEST_P(EveryFilter, WorksAgainAfterAnAbortAtAnyReport)
{
  for (int stop = 1;; stop += 1 + stop / 3) // first every report, then some
  {
    auto filter = this->GetParam().Make();
    filter->SetInputData(this->Surface);
    int reports = 0;
    const unsigned long tag = Listen(filter,
      [&](double amount)
      {
        // The pipeline itself sends the first and the last report.
        if (amount > 0.0 && amount < 1.0 && ++reports == stop)
        {
          filter->AbortExecuteOn();
        }
      });
    Messages messages(filter);
    filter->Update();
    ASSERT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    if (reports < stop)
    {
      EXPECT_GT(stop, 5); // or no early end was tested
      EXPECT_TRUE(Identical(this->ResultIn(filter), this->ResultIn(this->Reference)));
      return;
    }
    EXPECT_TRUE(IsUnchanged(filter, this->Surface)) << "report " << stop;
    EXPECT_EQ(reports, stop) << "went on after the abort";
    filter->RemoveObserver(tag);
    this->ExpectWorksNow(filter);
  }
}

TEST_P(EveryFilter, WorksAgainAfterWantOfMemoryAtAnyPlace)
{
#ifdef SURFACEDIFFUSION_FAIL_ALLOCATIONS
  for (long place = 1;; place += 1 + place / 3) // first every allocation, then some
  {
    auto filter = this->GetParam().Make();
    filter->SetInputData(this->Surface);
    Messages messages(filter);
    LargeBlocksLeft = place;
    Armed = true;
    filter->Update();
    Armed = false;
    if (LargeBlocksLeft > 0)
    {
      EXPECT_GT(place, 10); // or no early end was tested
      EXPECT_TRUE(Identical(this->ResultIn(filter), this->ResultIn(this->Reference)));
      return;
    }
    if (messages.Errors.empty()) // some algorithms, such as sorting, can do without the memory
    {
      EXPECT_TRUE(Identical(this->ResultIn(filter), this->ResultIn(this->Reference)));
      continue;
    }
    EXPECT_NE(messages.Errors[0].find("not enough memory"), std::string::npos)
      << messages.Errors[0];
    EXPECT_TRUE(IsUnchanged(filter, this->Surface)) << "block " << place;
    this->ExpectWorksNow(filter);
  }
#else
  GTEST_SKIP() << "allocations cannot be made to fail here";
#endif
}

INSTANTIATE_TEST_SUITE_P(Faults, EveryFilter, testing::ValuesIn(AllFilters()), KindName);

namespace
{
class IterativeFilter : public EveryFilter
{
};

std::vector<FilterKind> IterativeFilters()
{
  std::vector<FilterKind> kinds;
  for (const FilterKind& kind : AllFilters())
  {
    const std::string name = kind.Name;
    if (name == "HeatConjugateGradient" || name == "TV" || name == "PeronaMalik" ||
      name == "HarmonicExplicit" || name == "Turing" || name == "TuringFirstOrder")
    {
      kinds.push_back({ kind.Name,
        [make = kind.Make]
        {
          auto filter = make();
          vtkSurfaceDiffusionAlgorithm::SafeDownCast(filter)->SetSolverToConjugateGradient();
          return filter;
        },
        kind.Result });
    }
  }
  return kinds;
}
} // namespace

TEST_P(IterativeFilter, WorksAgainAfterTooFewIterations)
{
  auto made = this->GetParam().Make();
  auto* filter = vtkSurfaceDiffusionAlgorithm::SafeDownCast(made);
  filter->SetInputData(this->Surface);
  filter->SetMaximumNumberOfIterations(1);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("MaximumNumberOfIterations"), std::string::npos)
    << messages.Errors[0];
  EXPECT_TRUE(IsUnchanged(filter, this->Surface));
  filter->SetMaximumNumberOfIterations(1000);
  this->ExpectWorksNow(filter);
}

INSTANTIATE_TEST_SUITE_P(Faults, IterativeFilter, testing::ValuesIn(IterativeFilters()), KindName);
