// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PiecePartition.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Surface/TriangleMesh.h"

#include "vtkDataArray.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr int ExchangeTag = 7403;

} // namespace

PiecePartition::PiecePartition(
  const Processes& processes, const Surface& surface, const PointIdentity& identity)
  : Reduction(Reduction::Kind::Distributed)
  , Group(processes)
{
  this->FindSharedVertices(surface, identity);
  this->FindComponents(surface, identity);
  this->FindSharedEdges(surface, identity);
  this->FindCopies(surface, identity);
}

void PiecePartition::Sum(double* numbers, Index count) const
{
  std::vector<double> here(numbers, numbers + count);
  here.push_back(this->AbortAsked && *this->AbortAsked ? 1.0 : 0.0);
  std::vector<double> all(here.size());
  this->Group.Controller()->AllReduce(
    here.data(), all.data(), static_cast<vtkIdType>(all.size()), vtkCommunicator::SUM_OP);
  if (all.back() > 0.0)
  {
    throw Aborted();
  }
  std::copy_n(all.begin(), count, numbers);
}

void PiecePartition::Max(double* numbers, Index count) const
{
  const std::vector<double> here(numbers, numbers + count);
  this->Group.Controller()->AllReduce(here.data(), numbers, count, vtkCommunicator::MAX_OP);
}

/// Vertices whose points other processes have as vertices too belong to the first of them.
void PiecePartition::FindSharedVertices(const Surface& surface, const PointIdentity& identity)
{
  const TriangleMesh& mesh = surface.InputMesh();
  // A label of another piece tells that it is shared; one of this piece may be as well: all know
  // those that another piece refers to.
  std::vector<double> foreign;
  for (std::size_t i = 0; i < identity.Labels.size(); ++i)
  {
    if (identity.Labels[i] != identity.FirstLabel + static_cast<vtkIdType>(i))
    {
      foreign.push_back(static_cast<double>(identity.Labels[i]));
    }
  }
  const std::vector<double> all = this->Group.GatherAll(foreign);
  const std::set<double> shared(all.begin(), all.end());
  std::vector<double> mine; // process, label
  std::map<vtkIdType, Index> vertexOf;
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const vtkIdType label = identity.Labels[mesh.InputVertex()[v]];
    if (shared.count(static_cast<double>(label)) > 0)
    {
      mine.push_back(this->Group.Rank());
      mine.push_back(static_cast<double>(label));
      vertexOf[label] = v;
    }
  }
  const std::vector<double> having = this->Group.GatherAll(mine);
  for (std::size_t i = 0; i < having.size(); i += 2)
  {
    this->Sharers[static_cast<vtkIdType>(having[i + 1])].push_back(static_cast<int>(having[i]));
  }
  this->OwnedVertices.assign(mesh.NumberOfVertices(), true);
  for (const auto& [label, vertex] : vertexOf)
  {
    this->OwnedVertices[vertex] = this->Join(this->OfVertices, vertex, this->Sharers[label]);
  }
}

/// The first of the sharers owns the item; returns whether that is this process.
bool PiecePartition::Join(Seams& seams, Index item, const std::vector<int>& sharers) const
{
  const int owner = sharers.front();
  if (owner != this->Group.Rank())
  {
    seams.Taken[owner].push_back(item);
    return false;
  }
  for (std::size_t s = 1; s < sharers.size(); ++s)
  {
    seams.Given[sharers[s]].push_back(item);
  }
  return true;
}

/// Components of the pieces that share a vertex are one.
void PiecePartition::FindComponents(const Surface& surface, const PointIdentity& identity)
{
  const TriangleMesh& mesh = surface.InputMesh();
  std::vector<double> counts =
    this->Group.GatherAll({ static_cast<double>(mesh.NumberOfComponents()) });
  const double first = std::accumulate(counts.begin(), counts.begin() + this->Group.Rank(), 0.0);
  const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
  std::vector<double> mine; // label, component
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    for (Index v = mesh.ComponentsBegin()[c]; v < mesh.ComponentsBegin()[c + 1]; ++v)
    {
      const vtkIdType label = identity.Labels[mesh.InputVertex()[v]];
      const auto sharers = this->Sharers.find(label);
      if (sharers != this->Sharers.end() && sharers->second.size() > 1)
      {
        mine.push_back(static_cast<double>(label));
        mine.push_back(first + c);
      }
    }
  }
  const std::vector<double> all = this->Group.GatherAll(mine);
  DisjointSets connected(static_cast<Index>(sum));
  std::map<double, Index> componentOf;
  for (std::size_t i = 0; i < all.size(); i += 2)
  {
    const auto component = static_cast<Index>(all[i + 1]);
    const auto known = componentOf.emplace(all[i], component).first;
    connected.Join(component, known->second);
  }
  const std::vector<Index> numbers = connected.Labels();
  this->NumberOfComponents =
    numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + 1;
  const auto own = numbers.begin() + static_cast<std::ptrdiff_t>(first);
  this->SurfaceComponent.assign(own, own + mesh.NumberOfComponents());
}

/// Edges along seams are in two processes, and count once.
void PiecePartition::FindSharedEdges(const Surface& surface, const PointIdentity& identity)
{
  const TriangleMesh& mesh = surface.InputMesh();
  const auto labelOf = [&](Index vertex) { return identity.Labels[mesh.InputVertex()[vertex]]; };
  const auto isShared = [&](Index vertex)
  {
    const auto sharers = this->Sharers.find(labelOf(vertex));
    return sharers != this->Sharers.end() && sharers->second.size() > 1;
  };
  using Ends = std::pair<vtkIdType, vtkIdType>; // labels
  struct Edge
  {
    std::array<Index, 2> Vertices;
    double Length;
  };
  std::map<Ends, Edge> edges;
  const Triangles& corners = mesh.TriangleVertices();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = corners(t, (a + 1) % 3);
      const Index j = corners(t, (a + 2) % 3);
      if (isShared(i) && isShared(j))
      {
        edges[std::minmax(labelOf(i), labelOf(j))] = { { i, j }, mesh.Shapes()[t].EdgeLength(a) };
      }
    }
  }
  std::vector<double> mine; // process, labels
  for (const auto& edge : edges)
  {
    mine.push_back(this->Group.Rank());
    mine.push_back(static_cast<double>(edge.first.first));
    mine.push_back(static_cast<double>(edge.first.second));
  }
  const std::vector<double> all = this->Group.GatherAll(mine);
  std::map<Ends, std::vector<int>> sharers;
  for (std::size_t e = 0; e < all.size(); e += 3)
  {
    const Ends ends(static_cast<vtkIdType>(all[e + 1]), static_cast<vtkIdType>(all[e + 2]));
    if (edges.count(ends) > 0)
    {
      sharers[ends].push_back(static_cast<int>(all[e]));
    }
  }
  for (const auto& [ends, edge] : edges)
  {
    const std::vector<int>& processes = sharers[ends];
    if (processes.size() > 1)
    {
      const auto number = static_cast<Index>(this->EdgesOnInterface.size());
      const bool owned = this->Join(this->OfEdges, number, processes);
      this->EdgesOnInterface.push_back(edge.Vertices);
      this->OwnedEdges.push_back(owned);
      this->Edges += owned ? 0 : 1;
      this->EdgeLength += owned ? 0.0 : edge.Length;
    }
  }
}

/// Points of no triangle here (those of ghost cells, and those all of whose triangles here take no
/// part) that other pieces have: as a vertex, or else the one that they stand for.
void PiecePartition::FindCopies(const Surface& surface, const PointIdentity& identity)
{
  const int rank = this->Group.Rank();
  const std::vector<double> firsts =
    this->Group.GatherAll({ static_cast<double>(identity.FirstLabel) });
  const auto sourceOf = [&](vtkIdType label)
  {
    const auto sharers = this->Sharers.find(label);
    if (sharers != this->Sharers.end())
    {
      return sharers->second.front();
    }
    // Pieces without points begin at the label of the next one: the last that begins there has it.
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), static_cast<double>(label));
    return static_cast<int>(after - firsts.begin()) - 1;
  };
  std::vector<double> mine; // process, label
  for (std::size_t i = 0; i < identity.Labels.size(); ++i)
  {
    const vtkIdType label = identity.Labels[i];
    if (surface.VertexOf(static_cast<Index>(i)) < 0 && sourceOf(label) != rank)
    {
      mine.push_back(rank);
      mine.push_back(static_cast<double>(label));
      this->Copies[sourceOf(label)].push_back(static_cast<vtkIdType>(i));
      ++this->CopyCount;
    }
  }
  std::map<vtkIdType, vtkIdType> pointOf; // of shared labels that are vertices here
  for (const Index point : surface.InputMesh().InputVertex())
  {
    if (this->Sharers.count(identity.Labels[point]) > 0)
    {
      pointOf[identity.Labels[point]] = point;
    }
  }
  const std::vector<double> all = this->Group.GatherAll(mine);
  for (std::size_t i = 0; i < all.size(); i += 2)
  {
    const auto label = static_cast<vtkIdType>(all[i + 1]);
    if (sourceOf(label) == rank)
    {
      const auto point = pointOf.find(label);
      this->Originals[static_cast<int>(all[i])].push_back(
        point != pointOf.end() ? point->second : label - identity.FirstLabel);
    }
  }
}

/// Both send first what the other has room for: the one of lower rank begins.
void PiecePartition::Exchange(
  int other, const std::vector<double>& sent, std::vector<double>& received) const
{
  vtkMultiProcessController* const controller = this->Group.Controller();
  for (const bool send : { this->Group.Rank() < other, this->Group.Rank() > other })
  {
    if (send && !sent.empty())
    {
      controller->Send(sent.data(), static_cast<vtkIdType>(sent.size()), other, ExchangeTag);
    }
    else if (!send && !received.empty())
    {
      controller->Receive(
        received.data(), static_cast<vtkIdType>(received.size()), other, ExchangeTag);
    }
  }
}

namespace
{

/// The processes named in either, ascending.
template <typename Map>
std::set<int> Partners(const Map& a, const Map& b)
{
  std::set<int> partners;
  for (const Map* map : { &a, &b })
  {
    for (const auto& entry : *map)
    {
      partners.insert(entry.first);
    }
  }
  return partners;
}

template <typename Map>
const typename Map::mapped_type& At(const Map& map, int process)
{
  static const typename Map::mapped_type none;
  const auto found = map.find(process);
  return found == map.end() ? none : found->second;
}

} // namespace

void PiecePartition::UpdateFromOwners(Values& values) const
{
  this->Take(this->OfVertices, values.data(), static_cast<Index>(values.cols()));
}

void PiecePartition::Accumulate(double* rows, Index columns) const
{
  this->Add(this->OfVertices, rows, columns);
}

void PiecePartition::AccumulateInterfaceEdges(double* ofEdges) const
{
  this->Add(this->OfEdges, ofEdges, 1);
}

/// `columns` numbers of every item named in `given` go to the process that it is named for:
/// read(item, numbers) here, write(item, numbers) there, where it is in `taken`.
template <typename Items, typename Read, typename Write>
void PiecePartition::Pass(const Items& given, const Items& taken, std::size_t columns,
  const Read& read, const Write& write) const
{
  for (const int other : Partners(given, taken))
  {
    const auto& out = At(given, other);
    const auto& in = At(taken, other);
    std::vector<double> sent(out.size() * columns);
    std::vector<double> received(in.size() * columns);
    for (std::size_t i = 0; i < out.size(); ++i)
    {
      read(out[i], sent.data() + i * columns);
    }
    this->Exchange(other, sent, received);
    for (std::size_t i = 0; i < in.size(); ++i)
    {
      write(in[i], received.data() + i * columns);
    }
  }
}

void PiecePartition::Take(const Seams& seams, double* rows, Index columns) const
{
  const auto row = [&](Index item) { return rows + static_cast<std::ptrdiff_t>(item) * columns; };
  this->Pass(
    seams.Given, seams.Taken, columns,
    [&](Index item, double* numbers) { std::copy_n(row(item), columns, numbers); },
    [&](Index item, const double* numbers) { std::copy_n(numbers, columns, row(item)); });
}

/// Owners add up, in the order of processes, and tell the sums.
void PiecePartition::Add(const Seams& seams, double* rows, Index columns) const
{
  const auto row = [&](Index item) { return rows + static_cast<std::ptrdiff_t>(item) * columns; };
  this->Pass(
    seams.Taken, seams.Given, columns,
    [&](Index item, double* numbers) { std::copy_n(row(item), columns, numbers); },
    [&](Index item, const double* numbers)
    { std::transform(numbers, numbers + columns, row(item), row(item), std::plus<double>()); });
  this->Take(seams, rows, columns);
}

void PiecePartition::FillCopies(vtkDataArray* array) const
{
  this->Pass(
    this->Originals, this->Copies, static_cast<std::size_t>(array->GetNumberOfComponents()),
    [&](vtkIdType point, double* tuple) { array->GetTuple(point, tuple); },
    [&](vtkIdType point, const double* tuple) { array->SetTuple(point, tuple); });
}

} // namespace SurfaceDiffusion
