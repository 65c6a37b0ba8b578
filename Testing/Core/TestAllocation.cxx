// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Allocations.h"
#include "Core/Foundation/Types.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

// Eigen takes its memory from malloc, and so does operator new: all of it passes here. Only where
// the C library lets its malloc be replaced; a sanitizer has one of its own.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace
{
std::atomic<long> Allocations{ 0 };
std::atomic<long> AllocationsToFailure{ 0 };
}

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size)
{
  ++Allocations;
  return AllocationsToFailure > 0 && --AllocationsToFailure == 0 ? nullptr : __libc_malloc(size);
}

long SurfaceDiffusion::Testing::NumberOfAllocations()
{
  return Allocations;
}

void SurfaceDiffusion::Testing::FailAllocation(long number)
{
  AllocationsToFailure = number;
}

#else

long SurfaceDiffusion::Testing::NumberOfAllocations()
{
  return -1;
}

void SurfaceDiffusion::Testing::FailAllocation(long /*number*/) {}

#endif

TEST(Allocation, IsCounted)
{
  const long before = NumberOfAllocations();
  if (before < 0)
  {
    GTEST_SKIP() << "allocations cannot be counted here";
  }
  const Values u = Values::Zero(100, 1);
  EXPECT_GT(NumberOfAllocations(), before) << u(0, 0);
}
