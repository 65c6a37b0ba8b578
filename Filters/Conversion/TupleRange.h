// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"

namespace SurfaceDiffusion
{

/// Call visit(range) with a tuple range of the value type of the array.
template <typename Visitor>
void VisitTuples(vtkDataArray* array, const Visitor& visit)
{
  const auto work = [&](auto* typed) { visit(vtk::DataArrayTupleRange(typed)); };
  using Dispatch = vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::AllTypes>;
  if (!Dispatch::Execute(array, work))
  {
    work(array);
  }
}

} // namespace SurfaceDiffusion
