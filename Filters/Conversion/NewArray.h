// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkAbstractArray.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <memory>
#include <string>

namespace SurfaceDiffusion
{

/// A new array with `tuples` tuples. Throws std::bad_alloc if there is not enough memory, whereas
/// SetNumberOfTuples() ends the program unless VTK was built with NDEBUG.
template <typename Array>
vtkSmartPointer<Array> NewArray(const std::string& name, int components, vtkIdType tuples)
{
  using Value = typename Array::ValueType;
  const vtkIdType size = tuples * components;
  std::unique_ptr<Value[]> values(new Value[static_cast<std::size_t>(size)]);
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetArray(values.release(), size, 0, vtkAbstractArray::VTK_DATA_ARRAY_DELETE);
  return array;
}

} // namespace SurfaceDiffusion
