// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FilterTest.h"

#include "vtkIntrinsicTVFilter.h"

#include <cmath>
#include <functional>

/// Functions that the tests of vtkIntrinsicTVFilter share.
namespace IntrinsicTVTest
{
using namespace FilterTest;

using Filter = vtkIntrinsicTVFilter;
using Setting = std::function<void(Filter*)>;

inline vtkSmartPointer<Filter> MakeFilter(vtkDataObject* surface)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(surface);
  return filter;
}

inline vtkDataArray* Result(Filter* filter)
{
  return FilterTest::Result(filter, "fTV");
}

/// The axis of the cap. The boundary of the cap follows no edges of the mesh.
inline double Height(const double* p)
{
  return (p[0] + 2.0 * p[1] + 3.0 * p[2]) / std::sqrt(14.0);
}

/// 1 on the cap with cos(angle) > 1/2, 0 elsewhere.
inline double Cap(const double* p)
{
  return Height(p) > 0.5 ? 1.0 : 0.0;
}
}
