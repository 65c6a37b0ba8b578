// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Allocations.h"
#include "Core/Models/Trajectory.h"
#include "Heat.h"
#include "Meshes.h"

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
}

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size)
{
  ++Allocations;
  return __libc_malloc(size);
}

long SurfaceDiffusion::Testing::NumberOfAllocations()
{
  return Allocations;
}

#else

long SurfaceDiffusion::Testing::NumberOfAllocations()
{
  return -1;
}

#endif

namespace
{

/// Allocations of steps 2 .. 12 of a run of 12.
long AllocationsInLaterSteps(int columns, Scheme scheme, bool masked)
{
  const auto assembler = MakeAssembler(Icosphere(4)); // two blocks
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, columns));
  if (masked)
  {
    data.Missing.head(50) = true;
    data.Fixed.tail(50) = true;
  }
  Trajectory trajectory(assembler->SharedMesh(),
    MakeHeat(assembler, std::move(data), HeatSettings(mesh, 1e-3, 1.0, scheme),
      MakeConjugateGradientSolver()),
    std::size_t(1) << 28);
  const ProgressMonitor::Callback go = [](double) { return true; };
  trajectory.Reserve(12);
  trajectory.Seek(1, ProgressMonitor(go));
  const long before = NumberOfAllocations();
  trajectory.Seek(12, ProgressMonitor(go));
  trajectory.Seek(3, ProgressMonitor(go));
  return NumberOfAllocations() - before;
}

} // namespace

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

TEST(Allocation, StepsAfterTheFirstNeedNone)
{
  for (const int columns : { 1, 2, 3, 5 })
  {
    for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
    {
      for (const bool masked : { false, true })
      {
        EXPECT_EQ(AllocationsInLaterSteps(columns, scheme, masked), 0)
          << columns << " columns, scheme " << static_cast<int>(scheme) << ", " << masked;
      }
    }
  }
}
