// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PieceResults.h"

#include "Distributed/PackedPiece.h"
#include "Distributed/StitchedSurface.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <string>

namespace SurfaceDiffusion
{

namespace
{

constexpr int ResultTag = 7402;

vtkSmartPointer<vtkDataArray> RestrictArray(
  vtkDataArray* array, const std::vector<vtkIdType>& tuples, vtkIdType first, vtkIdType count)
{
  auto part = MakeSimilarArray(array, count);
  part->Fill(0.0);
  for (std::size_t i = 0; i < tuples.size(); ++i)
  {
    if (tuples[i] >= 0)
    {
      part->SetTuple(first + static_cast<vtkIdType>(i), tuples[i], array);
    }
  }
  return part;
}

} // namespace

std::vector<PieceResult> FindResults(vtkPolyData* input, vtkPolyData* output)
{
  std::vector<PieceResult> results;
  const auto compare =
    [&](vtkDataSetAttributes* before, vtkDataSetAttributes* after, PieceResult::Kind kind)
  {
    for (int a = 0; a < after->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = after->GetArray(a);
      if (array && before->GetArray(array->GetName()) != array)
      {
        results.push_back({ kind, array, after->IsArrayAnAttribute(a) });
      }
    }
  };
  compare(input->GetPointData(), output->GetPointData(), PieceResult::PointArray);
  compare(input->GetCellData(), output->GetCellData(), PieceResult::CellArray);
  if (input->GetPoints() != output->GetPoints())
  {
    results.push_back({ PieceResult::Coordinates, output->GetPoints()->GetData() });
  }
  return results;
}

std::vector<PieceResult> RestrictResults(
  const std::vector<PieceResult>& results, const GatheredPiece& piece)
{
  std::vector<PieceResult> restricted = results;
  for (PieceResult& result : restricted)
  {
    result.Array = result.Of == PieceResult::CellArray
      ? RestrictArray(result.Array, piece.SurfaceCells, piece.FirstCell, piece.NumberOfCells)
      : RestrictArray(result.Array, piece.SurfacePoints, 0, piece.NumberOfPoints);
  }
  return restricted;
}

void AddResults(const std::vector<PieceResult>& results, vtkPolyData* output)
{
  for (const PieceResult& result : results)
  {
    if (result.Of == PieceResult::Coordinates)
    {
      vtkNew<vtkPoints> points;
      points->SetData(result.Array);
      output->SetPoints(points);
      continue;
    }
    vtkDataSetAttributes* attributes = output->GetPointData();
    if (result.Of == PieceResult::CellArray)
    {
      attributes = output->GetCellData();
    }
    attributes->RemoveArray(result.Array->GetName()); // and its role, which it would keep
    const int index = attributes->AddArray(result.Array);
    if (result.Attribute >= 0)
    {
      attributes->SetActiveAttribute(index, result.Attribute);
    }
  }
}

void SendResults(
  vtkMultiProcessController* controller, int process, const std::vector<PieceResult>& results)
{
  vtkMultiProcessStream stream;
  stream << static_cast<int>(results.size());
  for (const PieceResult& result : results)
  {
    const int components = result.Array->GetNumberOfComponents();
    stream << static_cast<int>(result.Of) << result.Attribute << result.Array->GetDataType()
           << components;
    for (int k = 0; k < components; ++k)
    {
      const char* const name = result.Array->GetComponentName(k);
      stream << std::string(name ? name : "");
    }
  }
  controller->Send(stream, process, ResultTag);
  for (const PieceResult& result : results)
  {
    controller->Send(result.Array, process, ResultTag);
  }
}

std::vector<PieceResult> ReceiveResults(vtkMultiProcessController* controller)
{
  vtkMultiProcessStream stream;
  controller->Receive(stream, 0, ResultTag);
  int count = 0;
  stream >> count;
  std::vector<PieceResult> results(count);
  for (PieceResult& result : results)
  {
    int kind = 0;
    int type = 0;
    int components = 0;
    stream >> kind >> result.Attribute >> type >> components;
    result.Of = static_cast<PieceResult::Kind>(kind);
    result.Array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    controller->Receive(result.Array, 0, ResultTag);
    for (int k = 0; k < components; ++k)
    {
      std::string name;
      stream >> name;
      if (!name.empty())
      {
        result.Array->SetComponentName(k, name.c_str());
      }
    }
  }
  return results;
}

} // namespace SurfaceDiffusion
