// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/ContentHash.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"

#include <cstddef>
#include <cstdint>

namespace SurfaceDiffusion
{

void AddArray(Fingerprint& fingerprint, vtkDataArray* array, const ParallelFor& parallel)
{
  fingerprint.AddNumber(std::uint64_t{ array ? 1u : 0u });
  if (!array)
  {
    return;
  }
  fingerprint.AddNumber(static_cast<std::uint64_t>(array->GetDataType()));
  fingerprint.AddNumber(static_cast<std::uint64_t>(array->GetNumberOfComponents()));
  fingerprint.AddNumber(static_cast<std::uint64_t>(array->GetNumberOfTuples()));
  if (array->HasStandardMemoryLayout() && array->GetDataTypeSize() > 0)
  {
    const auto size = static_cast<std::size_t>(array->GetNumberOfValues()) *
      static_cast<std::size_t>(array->GetDataTypeSize());
    if (size > 0)
    {
      fingerprint.AddBytes(array->GetVoidPointer(0), size, parallel);
    }
    return;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      fingerprint.AddNumber(array->GetComponent(i, k));
    }
  }
}

void AddCells(Fingerprint& fingerprint, vtkCellArray* cells, const ParallelFor& parallel)
{
  const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
  fingerprint.AddNumber(static_cast<std::uint64_t>(count));
  if (count > 0)
  {
    AddArray(fingerprint, cells->GetOffsetsArray(), parallel);
    AddArray(fingerprint, cells->GetConnectivityArray(), parallel);
  }
}

} // namespace SurfaceDiffusion
