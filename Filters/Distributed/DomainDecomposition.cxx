// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DomainDecomposition.h"

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

DomainDecomposition::DomainDecomposition(
  const Processes& processes, const Surface& surface, const PointIdentity& identity)
  : InterfaceReduction(InterfaceExchange(processes))
  , Group(processes)
  , Neighbours(identity.Neighbours)
  , Edges(processes)
{
  this->FindInterfaceVertices(surface.InputMesh(), identity);
  this->MergeComponents(surface.InputMesh(), identity);
  this->FindInterfaceEdges(surface.InputMesh(), identity);
  this->FindCopies(surface, identity);
}

void DomainDecomposition::Sum(double* numbers, Index count) const
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

void DomainDecomposition::Max(double* numbers, Index count) const
{
  const std::vector<double> here(numbers, numbers + count);
  this->Group.Controller()->AllReduce(here.data(), numbers, count, vtkCommunicator::MAX_OP);
}

void DomainDecomposition::FindInterfaceVertices(
  const TriangleMesh& mesh, const PointIdentity& identity)
{
  std::vector<char> isShared(identity.Labels.size(), false);
  for (const vtkIdType point : identity.Shared)
  {
    isShared[point] = true;
  }
  std::vector<vtkIdType> labels;
  std::map<vtkIdType, Index> vertexOf;
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Index point = mesh.InputVertex()[v];
    if (isShared[point])
    {
      labels.push_back(identity.Labels[point]);
      vertexOf[identity.Labels[point]] = v;
    }
  }
  for (const auto& [process, held] : this->ShareWithNeighbours(labels))
  {
    for (const vtkIdType label : held)
    {
      this->Holders[label].push_back(process);
    }
  }
  this->OwnedVertices.assign(mesh.NumberOfVertices(), true);
  std::map<std::vector<int>, Index> sets;
  for (const auto& [label, vertex] : vertexOf)
  {
    if (this->IsOnInterface(label))
    {
      const std::vector<int>& holders = this->Holders[label];
      const auto set = sets.emplace(holders, static_cast<Index>(sets.size())).first;
      this->HolderSets.push_back(set->second);
      this->OwnedVertices[vertex] =
        this->Vertices.Add(static_cast<Index>(this->VerticesOnInterface.size()), holders);
      this->VerticesOnInterface.push_back(vertex);
    }
  }
}

/// The values of the neighbours and of this process, by rank.
std::map<int, std::vector<vtkIdType>> DomainDecomposition::ShareWithNeighbours(
  const std::vector<vtkIdType>& here) const
{
  std::map<int, std::vector<vtkIdType>> sent;
  for (const int process : this->Neighbours)
  {
    sent[process] = here;
  }
  std::map<int, std::vector<vtkIdType>> all = this->Group.Exchange(this->Neighbours, sent);
  all[this->Group.Rank()] = here;
  return all;
}

bool DomainDecomposition::IsOnInterface(vtkIdType label) const
{
  const auto holders = this->Holders.find(label);
  return holders != this->Holders.end() && holders->second.size() > 1;
}

/// Components of pieces that share a vertex are parts of one component of the surface.
void DomainDecomposition::MergeComponents(const TriangleMesh& mesh, const PointIdentity& identity)
{
  const std::vector<Index> counts = this->Group.GatherAll({ mesh.NumberOfComponents() });
  const Index first = std::accumulate(counts.begin(), counts.begin() + this->Group.Rank(), 0);
  std::vector<vtkIdType> pairs; // label, component numbered through all processes
  const auto& begins = mesh.ComponentsBegin();
  for (const Index v : this->VerticesOnInterface)
  {
    const auto next = std::upper_bound(begins.begin(), begins.end(), v);
    pairs.push_back(identity.Labels[mesh.InputVertex()[v]]);
    pairs.push_back(first + (next - begins.begin()) - 1);
  }
  std::map<vtkIdType, vtkIdType> own; // by label
  for (std::size_t i = 0; i < pairs.size(); i += 2)
  {
    own[pairs[i]] = pairs[i + 1];
  }
  std::set<std::array<vtkIdType, 2>> adjacent;
  for (const auto& [process, theirs] : this->ShareWithNeighbours(pairs))
  {
    for (std::size_t i = 0; i < theirs.size(); i += 2)
    {
      const auto found = own.find(theirs[i]);
      if (found != own.end())
      {
        adjacent.insert({ found->second, theirs[i + 1] });
      }
    }
  }
  std::vector<vtkIdType> joined;
  for (const auto& pair : adjacent)
  {
    joined.insert(joined.end(), pair.begin(), pair.end());
  }
  joined = this->Group.GatherAll(joined);
  DisjointSets connected(std::accumulate(counts.begin(), counts.end(), 0));
  for (std::size_t i = 0; i < joined.size(); i += 2)
  {
    connected.Join(static_cast<Index>(joined[i]), static_cast<Index>(joined[i + 1]));
  }
  const std::vector<Index> numbers = connected.Labels();
  this->NumberOfComponents =
    numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + 1;
  const auto here = numbers.begin() + first;
  this->SurfaceComponent.assign(here, here + mesh.NumberOfComponents());
}

/// Edges of this process between vertices on interfaces.
DomainDecomposition::EdgeMap DomainDecomposition::FindCandidateEdges(
  const TriangleMesh& mesh, const PointIdentity& identity) const
{
  const auto labelOf = [&](Index vertex) { return identity.Labels[mesh.InputVertex()[vertex]]; };
  const std::vector<char> isOnInterface = this->MarkInterfaces(mesh.NumberOfVertices());
  EdgeMap edges;
  const Triangles& corners = mesh.TriangleVertices();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = corners(t, (a + 1) % 3);
      const Index j = corners(t, (a + 2) % 3);
      if (isOnInterface[i] && isOnInterface[j])
      {
        edges[std::minmax(labelOf(i), labelOf(j))] = { i, j };
      }
    }
  }
  return edges;
}

void DomainDecomposition::FindInterfaceEdges(
  const TriangleMesh& mesh, const PointIdentity& identity)
{
  const EdgeMap edges = this->FindCandidateEdges(mesh, identity);
  std::vector<vtkIdType> ends;
  for (const auto& edge : edges)
  {
    ends.push_back(edge.first.first);
    ends.push_back(edge.first.second);
  }
  std::map<EdgeMap::key_type, std::vector<int>> holders;
  for (const auto& [process, theirs] : this->ShareWithNeighbours(ends))
  {
    for (std::size_t e = 0; e < theirs.size(); e += 2)
    {
      const EdgeMap::key_type key(theirs[e], theirs[e + 1]);
      if (edges.count(key) > 0)
      {
        holders[key].push_back(process);
      }
    }
  }
  for (const auto& [key, ofEdge] : edges)
  {
    if (holders[key].size() > 1)
    {
      const auto number = static_cast<Index>(this->EdgesOnInterface.size());
      const bool isOwned = this->Edges.Add(number, holders[key]);
      this->EdgesOnInterface.push_back(ofEdge);
      this->OwnedEdges.push_back(isOwned);
    }
  }
}

/// Finds the points that no triangle of this process uses (those of ghost cells, and those of
/// excluded triangles only) and that other pieces have: as a vertex, or else as the point that owns
/// them.
void DomainDecomposition::FindCopies(const Surface& surface, const PointIdentity& identity)
{
  const int rank = this->Group.Rank();
  const std::vector<vtkIdType> firsts = this->Group.GatherAll({ identity.FirstLabel });
  const auto sourceOf = [&](vtkIdType label)
  {
    const auto holders = this->Holders.find(label);
    if (holders != this->Holders.end())
    {
      return holders->second.front();
    }
    // A piece without points has the first label of the next one, which has the point.
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), label);
    return static_cast<int>(after - firsts.begin()) - 1;
  };
  std::map<int, std::vector<vtkIdType>> labels; // by the process that has the point
  for (std::size_t i = 0; i < identity.Labels.size(); ++i)
  {
    const vtkIdType label = identity.Labels[i];
    if (surface.VertexOf(static_cast<Index>(i)) < 0 && sourceOf(label) != rank)
    {
      labels[sourceOf(label)].push_back(label);
      this->Copies[sourceOf(label)].push_back(static_cast<vtkIdType>(i));
      ++this->CopyCount;
    }
  }
  std::map<vtkIdType, vtkIdType> pointOf; // of shared labels that are vertices here
  for (const vtkIdType point : identity.Shared)
  {
    if (surface.VertexOf(static_cast<Index>(point)) >= 0)
    {
      pointOf[identity.Labels[point]] = point;
    }
  }
  for (const auto& [process, asked] : this->Group.Exchange(this->Neighbours, labels))
  {
    for (const vtkIdType label : asked)
    {
      const auto point = pointOf.find(label);
      this->Originals[process].push_back(
        point != pointOf.end() ? point->second : label - identity.FirstLabel);
    }
  }
}

void DomainDecomposition::FillCopies(vtkDataArray* array) const
{
  ExchangeRows(
    this->Group, this->Originals, this->Copies,
    static_cast<std::size_t>(array->GetNumberOfComponents()),
    [&](vtkIdType point, double* tuple) { array->GetTuple(point, tuple); },
    [&](vtkIdType point, const double* tuple) { array->SetTuple(point, tuple); });
}

} // namespace SurfaceDiffusion
