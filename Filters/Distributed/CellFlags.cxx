// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/CellFlags.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstddef>

namespace SurfaceDiffusion
{

std::vector<unsigned char> FindCellFlags(vtkPolyData* surface)
{
  const vtkIdType count = surface->GetNumberOfCells();
  std::vector<unsigned char> flags;
  vtkUnsignedCharArray* const given = surface->GetCellGhostArray();
  if (given && given->GetNumberOfTuples() == count)
  {
    flags.assign(given->GetPointer(0), given->GetPointer(0) + count);
  }
  const std::vector<char> hidden = FindHiddenPoints(surface);
  if (hidden.empty())
  {
    return flags;
  }
  flags.resize(static_cast<std::size_t>(count), 0);
  const auto isHidden = [&](vtkIdType point)
  {
    return point >= 0 && point < static_cast<vtkIdType>(hidden.size()) &&
      hidden[static_cast<std::size_t>(point)] != 0;
  };
  auto flag = flags.begin();
  for (vtkCellArray* cells :
    { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
  {
    for (vtkIdType c = 0; cells && c < cells->GetNumberOfCells(); ++c, ++flag)
    {
      vtkIdType size = 0;
      const vtkIdType* points = nullptr;
      cells->GetCellAtId(c, size, points);
      if (std::any_of(points, points + size, isHidden))
      {
        *flag |= vtkDataSetAttributes::HIDDENCELL;
      }
    }
  }
  return flags;
}

std::vector<char> FindHiddenPoints(vtkDataSet* data)
{
  vtkUnsignedCharArray* const flags = data->GetPointGhostArray();
  const vtkIdType count = data->GetNumberOfPoints();
  std::vector<char> hidden;
  for (vtkIdType i = 0; flags && flags->GetNumberOfTuples() == count && i < count; ++i)
  {
    if (flags->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT)
    {
      hidden.resize(static_cast<std::size_t>(count), 0);
      hidden[static_cast<std::size_t>(i)] = 1;
    }
  }
  return hidden;
}

} // namespace SurfaceDiffusion
