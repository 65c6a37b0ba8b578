// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../Filters/FilterTest.h"

#include "vtkCommunicator.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiProcessController.h"

/// A square in strips, one per process.
namespace Pieces
{

using namespace FilterTest;

inline int Rank()
{
  return vtkMultiProcessController::GetGlobalController()->GetLocalProcessId();
}
inline int Count()
{
  return vtkMultiProcessController::GetGlobalController()->GetNumberOfProcesses();
}

inline double OfAll(double value, int operation)
{
  double all = 0.0;
  vtkMultiProcessController::GetGlobalController()->AllReduce(&value, &all, 1, operation);
  return all;
}

inline double Data(const double* x)
{
  return std::sin(2.0 * x[0]) + (x[1] > 0.4 ? 1.0 : 0.0);
}

/// A strip of the unit square, columns begin .. end of n, with data; its points are moved by shift.
inline vtkSmartPointer<vtkPolyData> Strip(int begin, int end, int n, double shift = 0.0)
{
  auto strip = Grid(end - begin + 1, n + 1, 1.0 / n);
  for (vtkIdType i = 0; i < strip->GetNumberOfPoints(); ++i)
  {
    double x[3];
    strip->GetPoint(i, x);
    x[0] = static_cast<double>(begin) / n + x[0] + shift;
    strip->GetPoints()->SetPoint(i, x);
  }
  AddPointArray(strip, "f", 1, [&](vtkIdType i, int) { return Data(strip->GetPoint(i)); });
  return strip;
}

inline vtkSmartPointer<vtkPolyData> Mine(int n, double shift = 0.0)
{
  return Strip(n * Rank() / Count(), n * (Rank() + 1) / Count(), n, shift);
}

} // namespace Pieces
