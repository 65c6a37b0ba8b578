// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/TriangleCells.h"
#include "Run/Fields.h"
#include "Run/Fingerprint.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// A numeric array that was chosen and that a block does not have.
struct AbsentArray
{
  int Index; ///< of SetInputArrayToProcess()
  std::string Label; ///< the property, and the name of the array if there is one
  std::string Problem; ///< the sentence if no block has it
};

using LocatedArray = Located<vtkSmartPointer<vtkDataArray>>;

/// A surface of the input with its arrays, found and checked.
struct InputFields
{
  vtkPolyData* Surface = nullptr; ///< must live until a run has read it
  std::string Name; ///< of a block, for messages
  std::vector<AbsentArray> Absent;
  vtkSmartPointer<vtkDataArray> NoDirection; ///< zeros: a block without the directions of others
  LocatedArray Data; ///< index 0
  bool AlphaIsData = false; ///< the last of 2 or 4 unsigned chars of the data is a component, too
  bool DataAreComputed = false; ///< normals that the input does not have
  bool ResultIsNormals = false; ///< the result of the data takes the place of the normals
  LocatedArray Mask; ///< index 1
  LocatedArray Direction; ///< index 2
  LocatedArray Fixed; ///< index 3
  vtkDataArray* Rates = nullptr; ///< index 4
  LocatedArray Fidelity; ///< index 5
  LocatedArray Seeds; ///< index 6
  const char* NameOfSeeds = "SeedArray"; ///< their property
  bool DataAreTerms = false; ///< Data is index 7
  std::shared_ptr<const PointSamples> Samples; ///< in place of Data
  std::shared_ptr<const SourceShapes> Sources; ///< in place of Data
  std::shared_ptr<const SourceShapes> PathPoints; ///< of distances
  LocatedArray Speeds; ///< index 8
  LocatedArray AlongSpeeds, AcrossSpeeds; ///< indices 11 and 12
  LocatedArray StartTimes; ///< index 9, on points
  LocatedArray SlopeErrors; ///< index 10, on points
  vtkDataArray* GlobalIds = nullptr; ///< of the points
  vtkDataArray* Between = nullptr; ///< as in Fields, see PieceRefinement
  vtkDataArray* GivenCells = nullptr; ///< likewise

  FieldSummary Summarize() const;
  /// All arrays, null for those that are not set.
  std::vector<vtkDataArray*> List() const;
  /// Which of them are on cells, as bits.
  unsigned int Associations() const;
};

/// The number of components that are data: unless alphaIsData, the last of 2 or 4 unsigned chars is
/// alpha, which is none.
int NumberOfDataComponents(vtkDataArray* array, bool alphaIsData = false);

/// All data components as doubles, one row per tuple.
Values ReadValues(vtkDataArray* array, bool alphaIsData = false);

/// The hash of everything that ReadFields() reads.
Fingerprint FingerprintFields(const InputFields& arrays);

/// cells: the cell of each triangle. Throws std::runtime_error, with the property's name, on infinite
/// directions and on rates that are negative or not finite.
Fields ReadFields(const InputFields& arrays, const TriangleCells& cells);

} // namespace SurfaceDiffusion
