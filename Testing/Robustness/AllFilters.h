// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkInformation.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMumfordShahFilter.h"
#include "vtkSurfaceCurvatureFilter.h"
#include "vtkSurfaceDenoisingFilter.h"
#include "vtkSurfaceDerivativesFilter.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkSurfaceRandomFieldFilter.h"
#include "vtkSurfaceReliefFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

/// The filters for tests of properties that all of them have.
namespace FilterTest
{

/// A line of kinds_of_run.txt.
struct FilterKind
{
  std::string Name;
  std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()> Make;
  std::string Result; ///< the array it adds
  bool IsSlow = false; ///< takes minutes on surfaces that suit the others

  /// The levels of a sphere for tests: those that suit the other kinds, or fewer.
  int Levels(int ofOthers) const { return this->IsSlow ? std::min(ofOthers, 3) : ofOthers; }
};

/// All kinds of kinds_of_run.txt.
const std::vector<FilterKind>& AllFilters();

/// The array that a run of this kind diffuses or fills in, "f", "rgb" or "c"; empty if there is none.
inline std::string DiffusedArray(const FilterKind& kind)
{
  const std::string& result = kind.Result;
  const std::size_t end = result.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  const std::string name = result.substr(0, end == std::string::npos ? 0 : end);
  return name == "f" || name == "rgb" || name == "c" ? name : "";
}

/// Whether SetInputArrayToProcess() has chosen an array of this index by its name.
inline bool HasInputArray(vtkAlgorithm* filter, int index)
{
  return filter->GetInputArrayInformation(index)->Has(vtkDataObject::FIELD_NAME()) != 0;
}

/// The weight of a point or cell in "weights" of AddArraysOfAllFilters().
inline double WeightOf(vtkIdType i)
{
  return i % 17 == 5 ? 0.0 : 0.5 + 0.25 * static_cast<double>(i % 4);
}

/// Adds the arrays other than "f" that some of AllFilters() take: the rough array "c" of cells,
/// the colours "rgb", the mask "mask", the directions "e1" and the labels "sources" of points, and the
/// weights "weights" of both, some of them 0.
void AddArraysOfAllFilters(vtkPolyData* surface);

inline std::string KindName(const testing::TestParamInfo<FilterKind>& info)
{
  return info.param.Name;
}

inline void PrintTo(const FilterKind& kind, std::ostream* os)
{
  *os << kind.Name;
}

/// The array that the filter has added to points or cells; null if there is none.
inline vtkDataArray* ResultOf(vtkPolyDataAlgorithm* filter, const std::string& name)
{
  vtkPolyData* output = filter->GetOutput();
  vtkDataArray* ofPoints = output->GetPointData()->GetArray(name.c_str());
  return ofPoints ? ofPoints : output->GetCellData()->GetArray(name.c_str());
}

/// Whether the output has the points, cells and arrays of the input, shared, and no others.
inline bool IsUnchanged(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  vtkPolyData* output = filter->GetOutput();
  bool same = output->GetPoints() == input->GetPoints() &&
    output->GetPolys() == input->GetPolys() &&
    output->GetPointData()->GetNumberOfArrays() == input->GetPointData()->GetNumberOfArrays() &&
    output->GetCellData()->GetNumberOfArrays() == input->GetCellData()->GetNumberOfArrays();
  for (int i = 0; same && i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    same =
      output->GetPointData()->GetAbstractArray(i) == input->GetPointData()->GetAbstractArray(i);
  }
  return same;
}

} // namespace FilterTest
