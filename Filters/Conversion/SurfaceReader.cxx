// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/SurfaceReader.h"

#include "Conversion/SMPParallelFor.h"
#include "Conversion/TupleRange.h"
#include "Core/Surface/Polygons.h"
#include "Distributed/CellFlags.h"
#include "Distributed/ContentHash.h"
#include "Run/InputSentences.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr vtkIdType LargestCount = std::numeric_limits<Index>::max();

Points ReadPoints(vtkPolyData* input)
{
  const ParallelFor& parallel = SMPParallelFor::Instance();
  const auto count = static_cast<Index>(input->GetNumberOfPoints());
  Points points(count, 3);
  if (count > 0)
  {
    VisitTuples(input->GetPoints()->GetData(),
      [&](const auto& from)
      {
        ForEach(parallel, count,
          [&](Index i)
          {
            for (int k = 0; k < 3; ++k)
            {
              points(i, k) = static_cast<double>(from[i][k]);
            }
          });
      });
  }
  RequireFiniteCoordinates(points, parallel);
  return points;
}

/// Reads the triangles of a surface without other cells and ghosts, and their cells, on all
/// threads. Returns false if it is not one, or if a corner is not a point, which Triangulator
/// reports.
bool ReadTriangles(vtkPolyData* input, Triangles& triangles, TriangleCells& cells)
{
  vtkCellArray* const polygons = input->GetPolys();
  if (!polygons || polygons->IsHomogeneous() != 3 || input->GetNumberOfStrips() > 0 ||
    input->GetCellGhostArray() || !FindHiddenPoints(input).empty())
  {
    return false;
  }
  const ParallelFor& parallel = SMPParallelFor::Instance();
  const auto count = static_cast<Index>(polygons->GetNumberOfCells());
  const vtkIdType points = input->GetNumberOfPoints();
  triangles.resize(count, 3);
  double isOutside = 0.0;
  VisitTuples(polygons->GetConnectivityArray(),
    [&](const auto& from)
    {
      isOutside = Max(parallel, count,
        [&](Index t)
        {
          bool isInside = true;
          for (int a = 0; a < 3; ++a)
          {
            const auto point = static_cast<vtkIdType>(from[vtkIdType(t) * 3 + a][0]);
            isInside = isInside && point >= 0 && point < points;
            triangles(t, a) = static_cast<Index>(point);
          }
          return isInside ? 0.0 : 1.0;
        });
    });
  if (isOutside > 0.0)
  {
    return false;
  }
  cells =
    TriangleCells(static_cast<Index>(input->GetNumberOfVerts() + input->GetNumberOfLines()), count);
  return true;
}

/// The triangles of the cells that are not excluded and not ghosts, each with its cell.
///
/// vtkTriangleFilter silently drops polygons that the ear cutting of vtkPolygon refuses, which
/// leaves holes (VTK 9.2): all that intersect themselves, valid ones of size 1e-150 or 1e150, and
/// half of a quad with a point twice. It also takes 60 times as long for quads and 7 times as long
/// for triangles (7.5 s against 0.12 s for a million quads), and its triangles of larger polygons are
/// others than those of CutPolygon(), which the functions of arrays in Python have, too.
///
/// Polygons are cut into triangles rather than given a Laplacian of their own (A. Bunge, P.
/// Herholz, M. Kazhdan, M. Botsch, Computer Graphics Forum 39, 2020). Measured with theirs on
/// spheres of 384 to 6144 quads, even and jittered, the error of a Poisson problem is 0.92 to 1.05
/// times that of triangles at 1.3 times the entries, and positive weights off the diagonal are as
/// large. The gain does not justify a second discretisation of every model.
class Triangulator
{
public:
  Triangulator(vtkPolyData* input, const Points& points)
    : Coordinates(points)
  {
    if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
    {
      RequireTuples(ghosts, input->GetNumberOfCells(), "cell");
    }
    this->Ghosts = FindCellFlags(input);
    const auto count = static_cast<std::size_t>(input->GetNumberOfPolys());
    this->Triangles.reserve(count);
    this->Cells.reserve(count);
    vtkIdType cell = input->GetNumberOfVerts() + input->GetNumberOfLines();
    this->AddCells(input->GetPolys(), cell, &Triangulator::AddPolygon);
    cell += input->GetNumberOfPolys();
    this->AddCells(input->GetStrips(), cell, &Triangulator::AddStrip);
  }

  std::vector<std::array<Index, 3>> Triangles;
  std::vector<Index> Cells;

private:
  using Adder = void (Triangulator::*)(vtkIdType cell, vtkIdType count, const vtkIdType* ids);

  void AddCells(vtkCellArray* cells, vtkIdType firstCell, Adder add)
  {
    constexpr unsigned char absent =
      vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    for (vtkIdType c = 0; c < count; ++c)
    {
      if (!this->Ghosts.empty() && (this->Ghosts[static_cast<std::size_t>(firstCell + c)] & absent))
      {
        continue;
      }
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCellAtId(c, size, ids);
      this->Check(firstCell + c, size, ids);
      (this->*add)(firstCell + c, size, ids);
    }
  }

  void Check(vtkIdType cell, vtkIdType count, const vtkIdType* ids) const
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (ids[i] < 0 || ids[i] >= this->Coordinates.rows())
      {
        throw InputError(Say("CellPoint", cell, ids[i], this->Coordinates.rows()));
      }
    }
  }

  void Add(vtkIdType cell, vtkIdType a, vtkIdType b, vtkIdType c)
  {
    this->Triangles.push_back(
      { static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c) });
    this->Cells.push_back(static_cast<Index>(cell));
  }

  void AddStrip(vtkIdType cell, vtkIdType count, const vtkIdType* ids)
  {
    for (vtkIdType i = 0; i + 2 < count; ++i)
    {
      this->Add(cell, ids[i], ids[i + 1 + i % 2], ids[i + 2 - i % 2]);
    }
  }

  void AddPolygon(vtkIdType cell, vtkIdType count, const vtkIdType* ids)
  {
    if (count == 3)
    {
      this->Add(cell, ids[0], ids[1], ids[2]);
      return;
    }
    this->Polygon.clear();
    for (vtkIdType i = 0; i < count; ++i)
    {
      this->Polygon.emplace_back(this->Coordinates.row(ids[i]));
    }
    for (const Corners& corners : CutPolygon(this->Polygon))
    {
      this->Add(cell, ids[corners[0]], ids[corners[1]], ids[corners[2]]);
    }
  }

  const Points& Coordinates;
  std::vector<unsigned char> Ghosts;
  std::vector<Eigen::RowVector3d> Polygon;
};

} // namespace

void RequireTuples(vtkDataArray* array, vtkIdType count, const char* what)
{
  if (array->GetNumberOfTuples() != count)
  {
    const char* const name = array->GetName();
    throw InputError(Say("Tuples", ArrayLabel("the input's array", name ? name : ""),
      array->GetNumberOfTuples(), count, what));
  }
}

Fingerprint FingerprintSurface(vtkPolyData* input, vtkDataArray* excluded, bool excludedCells)
{
  Fingerprint fingerprint;
  const ParallelFor& parallel = SMPParallelFor::Instance();
  AddArray(fingerprint, input->GetPoints() ? input->GetPoints()->GetData() : nullptr, parallel);
  fingerprint.AddNumber(static_cast<std::uint64_t>(input->GetNumberOfVerts()));
  fingerprint.AddNumber(static_cast<std::uint64_t>(input->GetNumberOfLines()));
  AddCells(fingerprint, input->GetPolys(), parallel);
  AddCells(fingerprint, input->GetStrips(), parallel);
  AddArray(fingerprint, input->GetCellGhostArray(), parallel);
  AddArray(fingerprint, input->GetPointGhostArray(), parallel);
  AddArray(fingerprint, excluded, parallel);
  fingerprint.AddNumber(std::uint64_t{ excludedCells ? 1u : 0u });
  return fingerprint;
}

SurfaceArrays ReadSurface(
  vtkPolyData* input, vtkDataArray* excluded, bool excludedCells, TriangleCells& cells)
{
  if (input->GetNumberOfPoints() > LargestCount)
  {
    throw std::runtime_error("the input has more points than this library can number");
  }
  if (input->GetNumberOfCells() > LargestCount)
  {
    throw std::runtime_error("the input has more cells than this library can number");
  }
  SurfaceArrays arrays;
  arrays.Points = ReadPoints(input);
  if (!ReadTriangles(input, arrays.Triangles, cells))
  {
    Triangulator triangulator(input, arrays.Points);
    if (static_cast<vtkIdType>(triangulator.Triangles.size()) > LargestCount)
    {
      throw std::runtime_error("the input has more triangles than this library can number");
    }
    arrays.Triangles.resize(static_cast<Eigen::Index>(triangulator.Triangles.size()), 3);
    for (std::size_t t = 0; t < triangulator.Triangles.size(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        arrays.Triangles(static_cast<Eigen::Index>(t), a) = triangulator.Triangles[t][a];
      }
    }
    cells = TriangleCells(std::move(triangulator.Cells));
  }
  arrays.Excluded = FindHiddenPoints(input); // whose triangles are left out above
  if (excluded && excludedCells)
  {
    for (std::size_t t = 0; t < cells.Size(); ++t)
    {
      arrays.ExcludedTriangles.push_back(excluded->GetComponent(cells[t], 0) != 0.0);
    }
  }
  else if (excluded)
  {
    arrays.Excluded.resize(static_cast<std::size_t>(input->GetNumberOfPoints()), 0);
    for (std::size_t i = 0; i < arrays.Excluded.size(); ++i)
    {
      arrays.Excluded[i] =
        arrays.Excluded[i] != 0 || excluded->GetComponent(static_cast<vtkIdType>(i), 0) != 0.0;
    }
  }
  return arrays;
}

} // namespace SurfaceDiffusion
