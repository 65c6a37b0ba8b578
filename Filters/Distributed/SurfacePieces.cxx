// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SurfacePieces.h"

#include "Distributed/Processes.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationExecutivePortKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <set>

namespace SurfaceDiffusion
{

namespace
{

/// The surfaces of composite data. Absent blocks are counted, since other processes may have them.
struct SurfaceList
{
  std::vector<std::string> Names; ///< see InputDescription
  /// The surface of each leaf that exists, in the order of vtkCompositeDataIterator.
  std::vector<int> OfLeaves;
  std::vector<vtkDataObject*> Leaves;

  void Add(vtkDataObject* data, const std::string& name, const std::string& path)
  {
    const auto pathOf = [&](unsigned int child)
    { return (path.empty() ? "" : path + "/") + std::to_string(child); };
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    {
      for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
      {
        this->Add(blocks->GetBlock(b),
          NameIn(blocks->HasMetaData(b) ? blocks->GetMetaData(b) : nullptr), pathOf(b));
      }
      return;
    }
    if (auto* members = vtkPartitionedDataSetCollection::SafeDownCast(data))
    {
      for (unsigned int m = 0; m < members->GetNumberOfPartitionedDataSets(); ++m)
      {
        this->Add(members->GetPartitionedDataSet(m),
          NameIn(members->HasMetaData(m) ? members->GetMetaData(m) : nullptr), pathOf(m));
      }
      return;
    }
    if (auto* partitions = vtkPartitionedDataSet::SafeDownCast(data)) // or vtkMultiPieceDataSet
    {
      for (unsigned int p = 0; p < partitions->GetNumberOfPartitions(); ++p)
      {
        this->AddLeaf(partitions->GetPartitionAsDataObject(p));
      }
    }
    else
    {
      this->AddLeaf(data);
    }
    this->Names.push_back(name.empty() ? path : '"' + name + '"');
  }

private:
  static std::string NameIn(vtkInformation* information)
  {
    return information && information->Has(vtkCompositeDataSet::NAME())
      ? information->Get(vtkCompositeDataSet::NAME())
      : "";
  }

  void AddLeaf(vtkDataObject* leaf)
  {
    if (leaf)
    {
      this->OfLeaves.push_back(static_cast<int>(this->Names.size()));
      this->Leaves.push_back(leaf);
    }
  }
};

/// Whether a connection was asked for one of several pieces, and a source before it makes pieces.
/// Only sources say that they do; filters behind them pass on what they get.
bool IsOneOfSeveralPieces(vtkInformation* connection)
{
  if (!connection ||
    connection->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) < 2)
  {
    return false;
  }
  if (connection->Has(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST()))
  {
    return true;
  }
  vtkExecutive* producer = nullptr;
  int output = 0;
  vtkExecutive::PRODUCER()->Get(connection, producer, output);
  for (int port = 0; producer && port < producer->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < producer->GetNumberOfInputConnections(port); ++i)
    {
      if (IsOneOfSeveralPieces(producer->GetInputInformation(port, i)))
      {
        return true;
      }
    }
  }
  return false;
}

} // namespace

bool MakeOutputObject(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  if (!input)
  {
    if (inputs[0]->GetNumberOfInformationObjects() == 0 && !output) // the executive reports it
    {
      auto nothing = vtkSmartPointer<vtkPolyData>::New();
      outputs->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), nothing);
    }
    return inputs[0]->GetNumberOfInformationObjects() == 0;
  }
  if (!output || !output->IsA(input->GetClassName()) || !input->IsA(output->GetClassName()))
  {
    auto made = vtkSmartPointer<vtkDataObject>::Take(input->NewInstance());
    outputs->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  return true;
}

std::vector<SurfacePiece> CopyStructure(vtkDataObject* input, vtkDataObject* output)
{
  std::vector<SurfacePiece> pieces;
  const auto add = [&](int surface, vtkDataObject* from, vtkDataObject* to)
  {
    if (auto* data = vtkPolyData::SafeDownCast(from))
    {
      pieces.push_back({ surface, data, vtkPolyData::SafeDownCast(to) });
    }
  };
  auto* compositeInput = vtkCompositeDataSet::SafeDownCast(input);
  auto* compositeOutput = vtkCompositeDataSet::SafeDownCast(output);
  if (!compositeInput)
  {
    output->ShallowCopy(input);
    add(0, input, output);
    return pieces;
  }
  compositeOutput->CopyStructure(compositeInput);
  compositeOutput->GetFieldData()->ShallowCopy(compositeInput->GetFieldData());
  output->GetInformation()->CopyEntry(input->GetInformation(), vtkDataObject::DATA_TIME_STEP());
  SurfaceList surfaces;
  surfaces.Add(input, "", "");
  std::size_t number = 0;
  auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(compositeInput->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    vtkDataObject* leaf = iterator->GetCurrentDataObject();
    auto copy = vtkSmartPointer<vtkDataObject>::Take(leaf->NewInstance());
    copy->ShallowCopy(leaf);
    compositeOutput->SetDataSet(iterator, copy);
    // Other kinds of composite data (AMR grids) hold no polydata.
    add(number < surfaces.OfLeaves.size() ? surfaces.OfLeaves[number] : 0, leaf, copy);
    ++number;
  }
  return pieces;
}

std::vector<vtkDataObject*> ListLeaves(vtkDataObject* data)
{
  SurfaceList surfaces;
  surfaces.Add(data, "", "");
  return surfaces.Leaves;
}

std::vector<int> ListSurfaces(vtkDataObject* data)
{
  SurfaceList surfaces;
  surfaces.Add(data, "", "");
  return surfaces.OfLeaves;
}

InputDescription DescribeInput(vtkDataObject* input)
{
  InputDescription description;
  description.IsComposite = vtkCompositeDataSet::SafeDownCast(input) != nullptr;
  SurfaceList surfaces;
  surfaces.Add(input, "", "");
  description.SurfaceNames = surfaces.Names;
  std::set<std::string> types;
  for (vtkDataObject* const leaf : surfaces.Leaves)
  {
    if (!vtkPolyData::SafeDownCast(leaf))
    {
      types.insert(leaf->GetClassName());
    }
  }
  for (const std::string& type : types)
  {
    description.OtherTypes += (description.OtherTypes.empty() ? "" : ", ") + type;
  }
  return description;
}

std::string DescribeLonePiece(
  vtkInformationVector** inputs, vtkMultiProcessController* controller, bool whole)
{
  vtkInformation* const input = inputs[0]->GetInformationObject(0);
  if (whole || Processes(controller).Count() > 1 || !IsOneOfSeveralPieces(input))
  {
    return "";
  }
  return "the input is one of " +
    std::to_string(input->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES())) +
    " pieces, and Controller has no process with the others; allowed: a controller of all "
    "processes, or null if each piece is a separate surface";
}

PieceSummary SummarizePieces(const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  std::vector<vtkIdType> all; // surface and number of points of each piece
  for (const SurfacePiece& piece : pieces)
  {
    all.insert(all.end(), { piece.Surface, piece.Input->GetNumberOfPoints() });
  }
  all = processes.GatherAll(all);
  PieceSummary summary;
  summary.OneSurface = !processes.Any(pieces.size() > 1);
  for (std::size_t i = 0; i < all.size(); i += 2)
  {
    summary.OneSurface = summary.OneSurface && all[i] == all[0];
    summary.NumberOfPoints += all[i + 1];
  }
  return summary;
}

bool HasPoints(const std::vector<SurfacePiece>& pieces)
{
  return std::any_of(pieces.begin(), pieces.end(),
    [](const SurfacePiece& piece) { return piece.Input->GetNumberOfPoints() > 0; });
}

bool HasSurfaceInPieces(const std::vector<SurfacePiece>& pieces)
{
  std::set<int> found;
  for (const SurfacePiece& piece : pieces)
  {
    if (piece.Input->GetNumberOfPoints() > 0 && !found.insert(piece.Surface).second)
    {
      return true;
    }
  }
  return false;
}

} // namespace SurfaceDiffusion
