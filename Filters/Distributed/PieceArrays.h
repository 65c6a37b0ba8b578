// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SurfacePieces.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkAlgorithm;
class vtkDataArray;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// An array that has to be the same in all pieces, or processes, that have it.
struct SharedArray
{
  std::string Key; ///< which one
  std::string Description; ///< name, numeric type, number of components, place
};

/// Whether an input array has flags, whose type has no meaning: MaskArray and FixedArray.
constexpr bool IsOfFlags(int index)
{
  return index == 1 || index == 3;
}

/// hasType: whether others have to be of the type.
SharedArray DescribeArray(
  const std::string& key, vtkDataArray* array, bool onCells, bool hasType = true);

/// The error if two arrays of one key differ, among those of all processes; otherwise empty.
/// Collective.
std::string FindDisagreement(const Processes& processes, const std::vector<SharedArray>& here);

/// The same for the arrays that SetInputArrayToProcess() chose for the filter, on the pieces of each
/// surface.
std::string FindDisagreement(
  const Processes& processes, vtkAlgorithm* filter, const std::vector<SurfacePiece>& pieces);

} // namespace SurfaceDiffusion
