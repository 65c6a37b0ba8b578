// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/GatheredSurfaces.h"

#include "Distributed/PieceResults.h"
#include "Distributed/PointIdentity.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr int PieceTag = 7401;

/// The numbers by which all processes know a piece.
struct PieceHeader
{
  static constexpr std::size_t Width = 6;

  vtkIdType Process, Surface, FirstLabel, FirstCell, Cells, Points;
};

std::vector<PieceHeader> GatherHeaders(const Processes& processes,
  const std::vector<SurfacePiece>& pieces, const std::vector<PointIdentity>& identities)
{
  std::vector<vtkIdType> numbers;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    vtkPolyData* const data = pieces[p].Input;
    numbers.insert(numbers.end(),
      { processes.Rank(), pieces[p].Surface, identities[p].FirstLabel,
        data->GetNumberOfVerts() + data->GetNumberOfLines(), data->GetNumberOfCells(),
        data->GetNumberOfPoints() });
  }
  numbers = processes.GatherAll(numbers);
  std::vector<PieceHeader> headers;
  for (std::size_t n = 0; n < numbers.size(); n += PieceHeader::Width)
  {
    headers.push_back({ numbers[n], numbers[n + 1], numbers[n + 2], numbers[n + 3], numbers[n + 4],
      numbers[n + 5] });
  }
  return headers;
}

} // namespace

void GatheredSurfaces::Update(const Processes& processes, const std::vector<SurfacePiece>& pieces,
  double tolerance, vtkAlgorithm* filter)
{
  Fingerprint contents;
  contents.AddNumber(tolerance);
  for (const SurfacePiece& piece : pieces)
  {
    contents.Add(FingerprintPiece(filter, piece));
  }
  if (processes.Any(this->Gathered != contents))
  {
    this->Gathered.reset();
    this->GatherPieces(processes, pieces, tolerance, filter);
    this->Gathered = contents;
  }
}

void GatheredSurfaces::GatherPieces(const Processes& processes,
  const std::vector<SurfacePiece>& pieces, double tolerance, vtkAlgorithm* filter)
{
  this->Surfaces.clear();
  this->Order.clear();
  const std::vector<PointIdentity> identities = FindIdentity(processes, pieces, tolerance);
  const int rank = processes.Rank();
  vtkIdType labels = 0;
  std::size_t next = 0; // of this process's pieces
  for (const PieceHeader& header : GatherHeaders(processes, pieces, identities))
  {
    GatheredPiece piece;
    piece.Process = static_cast<int>(header.Process);
    piece.FirstLabel = header.FirstLabel;
    piece.FirstCell = header.FirstCell;
    piece.NumberOfCells = header.Cells;
    piece.NumberOfPoints = header.Points;
    labels = std::max(labels, header.FirstLabel + header.Points);
    if (piece.Process == rank)
    {
      piece.Data = PackPiece(filter, pieces[next].Input, identities[next]);
      ++next;
    }
    if (piece.Process == rank && rank != 0)
    {
      processes.Controller()->Send(piece.Data, 0, PieceTag);
    }
    else if (piece.Process != rank && rank == 0)
    {
      piece.Data = vtkSmartPointer<vtkPolyData>::New();
      processes.Controller()->Receive(piece.Data, piece.Process, PieceTag);
    }
    if (rank == 0)
    {
      StitchedSurface& surface = this->FindSurface(static_cast<std::size_t>(header.Surface));
      this->Order.emplace_back(&surface, surface.Pieces.size());
      surface.Pieces.push_back(std::move(piece));
    }
  }
  for (const std::unique_ptr<StitchedSurface>& surface : this->Surfaces)
  {
    if (surface)
    {
      surface->NumberOfLabels = labels;
    }
  }
}

StitchedSurface& GatheredSurfaces::FindSurface(std::size_t number)
{
  this->Surfaces.resize(std::max(this->Surfaces.size(), number + 1));
  if (!this->Surfaces[number])
  {
    this->Surfaces[number] = std::make_unique<StitchedSurface>();
  }
  return *this->Surfaces[number];
}

std::vector<SurfacePiece> GatheredSurfaces::MakeOutputs()
{
  std::vector<SurfacePiece> outputs;
  const auto contents = std::exchange(
    this->Gathered, std::nullopt); // if memory runs out, gather again at the next update
  for (const std::unique_ptr<StitchedSurface>& surface : this->Surfaces)
  {
    if (surface && !surface->Data)
    {
      surface->StitchPieces();
    }
  }
  this->Gathered = contents;
  for (std::size_t number = 0; number < this->Surfaces.size(); ++number)
  {
    StitchedSurface* const surface = this->Surfaces[number].get();
    if (surface)
    {
      surface->Output = vtkSmartPointer<vtkPolyData>::New();
      surface->Output->ShallowCopy(surface->Data);
      outputs.push_back({ static_cast<int>(number), surface->Data, surface->Output });
    }
  }
  return outputs;
}

void GatheredSurfaces::ScatterResults(
  const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  if (processes.Rank() != 0)
  {
    for (const SurfacePiece& piece : pieces)
    {
      AddResults(ReceiveResults(processes.Controller()), piece.Output);
    }
    return;
  }
  std::map<const StitchedSurface*, std::vector<PieceResult>> results;
  for (const std::unique_ptr<StitchedSurface>& surface : this->Surfaces)
  {
    if (surface && surface->Output) // memory has sufficed
    {
      results[surface.get()] = FindResults(surface->Data, surface->Output);
      surface->Output = nullptr;
    }
  }
  std::size_t next = 0; // of this process's pieces
  for (const auto& [surface, number] : this->Order)
  {
    const GatheredPiece& piece = surface->Pieces[number];
    const std::vector<PieceResult> restricted = RestrictResults(results[surface], piece);
    if (piece.Process == 0)
    {
      AddResults(restricted, pieces[next++].Output);
    }
    else
    {
      SendResults(processes.Controller(), piece.Process, restricted);
    }
  }
}

} // namespace SurfaceDiffusion
