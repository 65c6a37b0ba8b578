// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PolyDataSurface.h"

#include "Conversion/SMPParallelFor.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkStaticPointLocator.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

constexpr vtkIdType LargestCount = std::numeric_limits<Index>::max() / 6; // 6 slots per corner pair

vtkMTimeType TimeOf(vtkCellArray* cells)
{
  return cells ? std::max({ cells->GetMTime(), cells->GetOffsetsArray()->GetMTime(),
                   cells->GetConnectivityArray()->GetMTime() })
               : 0;
}

Points ReadPoints(vtkPolyData* input)
{
  const vtkIdType count = input->GetNumberOfPoints();
  Points points(count, 3);
  for (vtkIdType i = 0; i < count; ++i)
  {
    input->GetPoint(i, points.row(i).data());
    if (!points.row(i).allFinite())
    {
      std::ostringstream text;
      text << "point " << i << " of the input has coordinates that are not finite";
      throw std::runtime_error(text.str());
    }
  }
  return points;
}

/// For every point the one it stands for: itself, or the first of those it coincides with.
std::vector<vtkIdType> Representatives(vtkPolyData* input, const PolyDataSurface::Options& options)
{
  std::vector<vtkIdType> representative(input->GetNumberOfPoints());
  if (options.MergeCoincidentPoints && input->GetNumberOfPoints() > 0)
  {
    vtkNew<vtkPolyData> cloud; // the locator builds on points alone
    cloud->SetPoints(input->GetPoints());
    vtkNew<vtkStaticPointLocator> locator;
    locator->SetDataSet(cloud);
    locator->BuildLocator();
    locator->MergePoints(options.MergeTolerance, representative.data());
  }
  else
  {
    for (std::size_t i = 0; i < representative.size(); ++i)
    {
      representative[i] = static_cast<vtkIdType>(i);
    }
  }
  return representative;
}

/// The triangles of the cells that are not excluded and not ghosts, each with its cell.
///
/// vtkTriangleFilter cuts most polygons alike: quads along the shorter diagonal that lies inside,
/// others by the same ear cutting of vtkPolygon, and an array of cell ids would give the cells. But
/// it silently drops polygons that ear cutting refuses, which leaves holes (VTK 9.2): all that
/// cross themselves, valid ones of size 1e-150 or 1e150, and half of a quad that has a point twice.
/// It also takes 60 times as long for quads and 7 times as long for triangles (7.5 s against 0.12 s
/// for a million quads).
///
/// Polygons are cut into triangles rather than given a Laplacian of their own (A. Bunge, P.
/// Herholz, M. Kazhdan, M. Botsch, Computer Graphics Forum 39, 2020). Measured with theirs on
/// spheres of 384 to 6144 quads, even and jittered, the error of a Poisson problem is 0.92 to 1.05
/// times that of triangles at 1.3 times the entries, and positive weights off the diagonal are as
/// large: nothing is gained that a second discretisation of every model would be worth.
class Triangulator
{
public:
  Triangulator(vtkPolyData* input, const PolyDataSurface::Options& options, const Points& points)
    : Coordinates(points)
    , Representative(Representatives(input, options))
    , Excluded(options.Excluded)
  {
    if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
    {
      RequireTuples(ghosts, input->GetNumberOfCells(), "cell");
      this->Ghosts = ghosts->GetPointer(0);
    }
    vtkIdType cell = input->GetNumberOfVerts() + input->GetNumberOfLines();
    this->AddCells(input->GetPolys(), cell, &Triangulator::AddPolygon);
    cell += input->GetNumberOfPolys();
    this->AddCells(input->GetStrips(), cell, &Triangulator::AddStrip);
  }

  std::vector<std::array<Index, 3>> Triangles;
  std::vector<vtkIdType> Cells;

private:
  using Adder = void (Triangulator::*)(vtkIdType cell, vtkIdType count, const vtkIdType* ids);

  void AddCells(vtkCellArray* cells, vtkIdType firstCell, Adder add)
  {
    constexpr unsigned char absent =
      vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    for (vtkIdType c = 0; c < count; ++c)
    {
      if (this->Ghosts && (this->Ghosts[firstCell + c] & absent))
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
        std::ostringstream text;
        text << "cell " << cell << " of the input refers to point " << ids[i] << ", but there are "
             << this->Coordinates.rows() << " points";
        throw std::runtime_error(text.str());
      }
    }
  }

  void Add(vtkIdType cell, vtkIdType a, vtkIdType b, vtkIdType c)
  {
    if (this->Excluded &&
      (this->Excluded->GetComponent(a, 0) != 0.0 || this->Excluded->GetComponent(b, 0) != 0.0 ||
        this->Excluded->GetComponent(c, 0) != 0.0))
    {
      return;
    }
    this->Triangles.push_back({ static_cast<Index>(this->Representative[a]),
      static_cast<Index>(this->Representative[b]), static_cast<Index>(this->Representative[c]) });
    this->Cells.push_back(cell);
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
    }
    else if (count == 4)
    {
      this->AddQuad(cell, ids);
    }
    else if (count > 4)
    {
      this->AddByEarCutting(cell, count, ids);
    }
  }

  /// Cut along the shorter diagonal that lies inside, at whichever corner the numbering starts.
  void AddQuad(vtkIdType cell, const vtkIdType* ids)
  {
    using Row3 = Eigen::RowVector3d;
    const auto at = [&](int i) -> Row3 { return this->Coordinates.row(ids[i]); };
    const auto normal = [&](int a, int b, int c) -> Row3
    {
      const Row3 u = at(b) - at(a);
      const Row3 v = at(c) - at(a);
      return Row3(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    };
    const bool firstInside = normal(0, 1, 2).dot(normal(0, 2, 3)) > 0.0;
    const bool secondInside = normal(1, 2, 3).dot(normal(1, 3, 0)) > 0.0;
    const bool firstShorter = (at(0) - at(2)).norm() <= (at(1) - at(3)).norm();
    if (firstInside == secondInside ? firstShorter : firstInside)
    {
      this->Add(cell, ids[0], ids[1], ids[2]);
      this->Add(cell, ids[0], ids[2], ids[3]);
    }
    else
    {
      this->Add(cell, ids[1], ids[2], ids[3]);
      this->Add(cell, ids[1], ids[3], ids[0]);
    }
  }

  void AddByEarCutting(vtkIdType cell, vtkIdType count, const vtkIdType* ids)
  {
    this->Polygon->PointIds->SetNumberOfIds(count);
    this->Polygon->Points->SetNumberOfPoints(count);
    for (vtkIdType i = 0; i < count; ++i)
    {
      this->Polygon->PointIds->SetId(i, i);
      this->Polygon->Points->SetPoint(i, this->Coordinates.row(ids[i]).data());
    }
    this->Ears->Reset();
    if (this->Polygon->EarCutTriangulation(this->Ears) && this->Ears->GetNumberOfIds() > 0)
    {
      for (vtkIdType i = 0; i + 2 < this->Ears->GetNumberOfIds(); i += 3)
      {
        this->Add(cell, ids[this->Ears->GetId(i)], ids[this->Ears->GetId(i + 1)],
          ids[this->Ears->GetId(i + 2)]);
      }
      return;
    }
    for (vtkIdType i = 1; i + 1 < count; ++i) // crossing or flat: a fan covers it
    {
      this->Add(cell, ids[0], ids[i], ids[i + 1]);
    }
  }

  const Points& Coordinates;
  const std::vector<vtkIdType> Representative;
  vtkDataArray* Excluded;
  const unsigned char* Ghosts = nullptr;
  vtkNew<vtkPolygon> Polygon;
  vtkNew<vtkIdList> Ears;

public:
  vtkIdType RepresentativeOf(vtkIdType point) const { return this->Representative[point]; }
};

/// What takes long to make. It owns all it needs: an abort leaves it to itself.
struct Made
{
  SurfaceDiffusion::Points Points;
  SurfaceDiffusion::Triangles Triangles;
  std::shared_ptr<TriangleMesh> InputMesh;
  std::shared_ptr<const IntrinsicDelaunay> Delaunay;
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Assembler> Operators;

  void Make(bool delaunay, double lengthUnit, const ProgressMonitor& progress)
  {
    const ParallelFor& parallel = SMPParallelFor::Instance();
    this->InputMesh = std::make_shared<TriangleMesh>(
      this->Points, this->Triangles, parallel, progress.Part(0.0, 0.5), lengthUnit);
    this->Mesh = this->InputMesh;
    if (delaunay)
    {
      this->Delaunay =
        std::make_shared<IntrinsicDelaunay>(this->InputMesh, parallel, progress.Part(0.5, 0.6));
      this->Mesh = this->Delaunay->Mesh();
    }
    this->Operators = std::make_shared<Assembler>(this->Mesh, parallel, progress.Part(0.6, 1.0));
  }
};

/// Points on boundary edges that share their place with another one: a seam nobody sewed.
vtkIdType CountCoincidentBoundaryPoints(const TriangleMesh& mesh, const Points& points)
{
  std::vector<std::array<double, 3>> places;
  places.reserve(mesh.BoundaryVertices().size());
  for (const Index vertex : mesh.BoundaryVertices())
  {
    const auto row = points.row(mesh.InputVertex()[vertex]);
    places.push_back({ row[0], row[1], row[2] });
  }
  std::sort(places.begin(), places.end());
  vtkIdType count = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    count += (i > 0 && places[i] == places[i - 1]) ||
      (i + 1 < places.size() && places[i] == places[i + 1]);
  }
  return count;
}

} // namespace

std::string PolyDataSurface::Key(vtkPolyData* input, const Options& options)
{
  std::ostringstream key;
  key << input->GetPoints() << ' ' << (input->GetPoints() ? input->GetPoints()->GetMTime() : 0)
      << ' ' << input->GetNumberOfPoints() << ' ' << TimeOf(input->GetPolys()) << ' '
      << TimeOf(input->GetStrips()) << ' ' << input->GetNumberOfVerts() << ' '
      << input->GetNumberOfLines() << ' ';
  if (vtkUnsignedCharArray* ghosts = input->GetCellGhostArray())
  {
    key << ghosts->GetMTime();
  }
  key << ' ' << options.IntrinsicDelaunay << ' ' << options.MergeCoincidentPoints << ' '
      << std::hexfloat << options.MergeTolerance << ' ';
  if (options.Excluded)
  {
    key << options.Excluded->GetMTime();
  }
  return key.str();
}

void RequireTuples(vtkDataArray* array, vtkIdType count, const char* what)
{
  if (array->GetNumberOfTuples() != count)
  {
    std::ostringstream text;
    text << "the input's array \"" << (array->GetName() ? array->GetName() : "") << "\" has "
         << array->GetNumberOfTuples() << " tuples; allowed: " << count << ", one per " << what;
    throw std::runtime_error(text.str());
  }
}

PolyDataSurface::PolyDataSurface(
  vtkPolyData* input, const Options& options, const ProgressMonitor& progress)
{
  if (input->GetNumberOfPoints() > LargestCount)
  {
    throw std::runtime_error("the input has more points than this library can number");
  }
  const auto made = std::make_shared<Made>();
  made->Points = ReadPoints(input);
  progress.Report(0.1);
  Triangulator triangulator(input, options, made->Points);
  if (static_cast<vtkIdType>(triangulator.Triangles.size()) > LargestCount)
  {
    throw std::runtime_error("the input has more triangles than this library can number");
  }
  made->Triangles.resize(static_cast<Eigen::Index>(triangulator.Triangles.size()), 3);
  for (std::size_t t = 0; t < triangulator.Triangles.size(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      made->Triangles(static_cast<Eigen::Index>(t), a) = triangulator.Triangles[t][a];
    }
  }
  this->TriangleCells = std::move(triangulator.Cells);
  progress.Report(0.2);
  constexpr Eigen::Index quick = 5000; // points: not worth a thread
  if (made->Points.rows() < quick)
  {
    made->Make(options.IntrinsicDelaunay, options.LengthUnit, progress.Part(0.2, 1.0));
  }
  else
  {
    RunInBackground([made, delaunay = options.IntrinsicDelaunay, unit = options.LengthUnit]
      { made->Make(delaunay, unit, ProgressMonitor()); },
      progress.Part(0.2, 1.0));
  }
  this->Points = std::move(made->Points);
  this->Triangles = std::move(made->Triangles);
  this->InputMesh = std::move(made->InputMesh);
  this->Delaunay = std::move(made->Delaunay);
  this->Mesh = std::move(made->Mesh);
  this->Operators = std::move(made->Operators);

  this->PointToVertex.assign(this->Points.rows(), -1);
  for (Index v = 0; v < this->Mesh->NumberOfVertices(); ++v)
  {
    this->PointToVertex[this->Mesh->InputVertex()[v]] = v;
  }
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const Index vertex = this->PointToVertex[triangulator.RepresentativeOf(i)];
    this->PointToVertex[i] = vertex;
    const bool excluded = options.Excluded && options.Excluded->GetComponent(i, 0) != 0.0;
    this->Found.UnusedPoints += vertex < 0 && !excluded;
  }
  this->Found.DegenerateTriangles = this->Mesh->Diagnostics().DegenerateTriangles;
  this->Found.NonManifoldEdges = this->Mesh->Diagnostics().NonManifoldEdges;
  if (!options.MergeCoincidentPoints)
  {
    this->Found.CoincidentBoundaryPoints = CountCoincidentBoundaryPoints(*this->Mesh, this->Points);
  }
}

} // namespace SurfaceDiffusion
