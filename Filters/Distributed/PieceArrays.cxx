// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PieceArrays.h"

#include "Conversion/InputArrays.h"
#include "Distributed/Processes.h"
#include "Run/InputSentences.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

#include <map>

namespace SurfaceDiffusion
{

namespace
{

constexpr char End = '\0'; ///< of a text, which no name contains

} // namespace

SharedArray DescribeArray(const std::string& key, vtkDataArray* array, bool onCells, bool hasType)
{
  return { key,
    DescribeArray(array->GetName() ? array->GetName() : "",
      hasType ? array->GetDataTypeAsString() : "", array->GetNumberOfComponents(), onCells) };
}

std::string FindDisagreement(const Processes& processes, const std::vector<SharedArray>& here)
{
  std::vector<char> text;
  for (const SharedArray& array : here)
  {
    for (const std::string& part : { array.Key, array.Description })
    {
      text.insert(text.end(), part.begin(), part.end());
      text.push_back(End);
    }
  }
  text = processes.GatherAll(text);
  std::map<std::string, std::string> descriptions;
  std::vector<std::string> parts(1);
  for (const char character : text)
  {
    if (character != End)
    {
      parts.back().push_back(character);
      continue;
    }
    if (parts.size() == 2)
    {
      const auto known = descriptions.insert({ parts[0], parts[1] }).first;
      if (known->second != parts[1])
      {
        return Say("Unlike", known->second, parts[1]).Text();
      }
      parts.clear();
    }
    parts.emplace_back();
  }
  return "";
}

std::string FindDisagreement(
  const Processes& processes, vtkAlgorithm* filter, const std::vector<SurfacePiece>& pieces)
{
  if (processes.Count() == 1 && !HasSurfaceInPieces(pieces))
  {
    return "";
  }
  vtkInformationVector* const infos =
    filter->GetInformation()->Get(vtkAlgorithm::INPUT_ARRAYS_TO_PROCESS());
  std::vector<SharedArray> arrays;
  for (const SurfacePiece& piece : pieces)
  {
    for (int i = 0; infos && i < infos->GetNumberOfInformationObjects(); ++i)
    {
      const LocatedArray array = FindChosenArray(filter, i, piece.Input);
      if (array.Values && piece.Input->GetNumberOfPoints() > 0)
      {
        arrays.push_back(DescribeArray(std::to_string(piece.Surface) + ' ' + std::to_string(i),
          array.Values, array.OnCells, !IsOfFlags(i)));
      }
    }
  }
  return FindDisagreement(processes, arrays);
}

} // namespace SurfaceDiffusion
