// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/GatheredSurfaces.h"

#include "Conversion/PolyDataSurface.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr int PieceTag = 7401;
constexpr int ResultTag = 7402;

const char* const LabelName = "surface diffusion label";

/// The active attributes that filters read.
constexpr int ReadAttributes[] = { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS,
  vtkDataSetAttributes::NORMALS };

bool IsRead(vtkAlgorithm* filter, vtkAbstractArray* array)
{
  vtkInformationVector* const infos =
    filter->GetInformation()->Get(vtkAlgorithm::INPUT_ARRAYS_TO_PROCESS());
  for (int i = 0; infos && i < infos->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const info = infos->GetInformationObject(i);
    const char* const name =
      info->Has(vtkDataObject::FIELD_NAME()) ? info->Get(vtkDataObject::FIELD_NAME()) : nullptr;
    if (name && array->GetName() && std::string(name) == array->GetName())
    {
      return true;
    }
  }
  return false;
}

bool IsActive(vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return std::any_of(std::begin(ReadAttributes), std::end(ReadAttributes),
    [&](int type) { return attributes->GetAbstractAttribute(type) == array; });
}

/// An array of the same kind with room for `count` tuples.
template <typename Array>
vtkSmartPointer<Array> MakeLike(Array* array, vtkIdType count)
{
  auto made = vtkSmartPointer<Array>::Take(array->NewInstance());
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->CopyComponentNames(array);
  made->SetNumberOfTuples(count);
  return made;
}

/// Tuples first .. first + count of the arrays that the filter reads.
void PackAttributes(vtkAlgorithm* filter, vtkDataSetAttributes* from, vtkIdType first,
  vtkIdType count, vtkDataSetAttributes* to)
{
  for (int a = 0; a < from->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* const array = from->GetAbstractArray(a);
    if ((!IsRead(filter, array) && !IsActive(from, array)) ||
      array->GetNumberOfTuples() < first + count)
    {
      continue;
    }
    const auto copy = MakeLike(array, count);
    copy->InsertTuples(0, count, first, array);
    const int index = to->AddArray(copy);
    for (const int type : ReadAttributes)
    {
      if (from->GetAbstractAttribute(type) == array)
      {
        to->SetActiveAttribute(index, type);
      }
    }
  }
}

/// What process 0 needs of a piece: points, polygons, strips, their ghosts, arrays, labels, ids.
vtkSmartPointer<vtkPolyData> Pack(
  vtkAlgorithm* filter, vtkPolyData* input, const PointIdentity& identity)
{
  auto packed = vtkSmartPointer<vtkPolyData>::New();
  packed->SetPoints(input->GetPoints());
  packed->SetPolys(input->GetPolys());
  packed->SetStrips(input->GetStrips());
  const vtkIdType points = input->GetNumberOfPoints();
  const vtkIdType first = input->GetNumberOfVerts() + input->GetNumberOfLines();
  const vtkIdType cells = input->GetNumberOfPolys() + input->GetNumberOfStrips();
  PackAttributes(filter, input->GetPointData(), 0, points, packed->GetPointData());
  PackAttributes(filter, input->GetCellData(), first, cells, packed->GetCellData());
  vtkNew<vtkIdTypeArray> labels, ids;
  labels->SetName(LabelName);
  labels->SetNumberOfTuples(points);
  ids->SetName("GlobalPointIds");
  ids->SetNumberOfTuples(points);
  for (vtkIdType i = 0; i < points; ++i)
  {
    labels->SetValue(i, identity.Labels[i]);
    ids->SetValue(i, identity.Ids[i]);
  }
  packed->GetPointData()->AddArray(labels);
  packed->GetPointData()->SetGlobalIds(ids);
  vtkUnsignedCharArray* const ghosts = input->GetCellGhostArray();
  if (ghosts && ghosts->GetNumberOfTuples() == input->GetNumberOfCells())
  {
    vtkNew<vtkUnsignedCharArray> ofCells;
    ofCells->SetName(vtkDataSetAttributes::GhostArrayName());
    ofCells->InsertTuples(0, cells, first, ghosts);
    packed->GetCellData()->AddArray(ofCells);
  }
  vtkDataArray* const cellIds = input->GetCellData()->GetGlobalIds();
  if (cellIds && cellIds->GetNumberOfTuples() == input->GetNumberOfCells())
  {
    vtkNew<vtkIdTypeArray> ofCells;
    ofCells->SetName("GlobalCellIds");
    ofCells->InsertTuples(0, cells, first, cellIds);
    packed->GetCellData()->SetGlobalIds(ofCells);
  }
  return packed;
}

std::string KeyOf(vtkAlgorithm* filter, const std::vector<SurfacePiece>& pieces, double tolerance)
{
  std::ostringstream key;
  key << std::hexfloat << tolerance;
  const auto add = [&](vtkAbstractArray* array)
  { key << ' ' << array << ' ' << (array ? array->GetMTime() : 0); };
  for (const SurfacePiece& piece : pieces)
  {
    key << ' ' << piece.Surface << ' ' << piece.Input << ' '
        << PolyDataSurface::Key(piece.Input, PolyDataSurface::Options());
    for (vtkDataSetAttributes* attributes :
      { static_cast<vtkDataSetAttributes*>(piece.Input->GetPointData()),
        static_cast<vtkDataSetAttributes*>(piece.Input->GetCellData()) })
    {
      add(attributes->GetGlobalIds());
      add(attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
      for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
      {
        vtkAbstractArray* const array = attributes->GetAbstractArray(a);
        const bool active = IsActive(attributes, array);
        if (active || IsRead(filter, array))
        {
          add(array);
          key << active;
        }
      }
    }
  }
  return key.str();
}

} // namespace

/// A piece in process 0.
struct GatheredSurfaces::Part
{
  int Process = 0;
  vtkIdType FirstLabel = 0;
  vtkIdType FirstCell = 0; ///< its first polygon among its cells
  vtkIdType NumberOfCells = 0; ///< of the piece, vertices and lines too
  vtkIdType NumberOfPoints = 0;
  vtkSmartPointer<vtkPolyData> Data; ///< packed; freed when the whole is made
  std::vector<vtkIdType> PointOfWhole; ///< per point
  std::vector<vtkIdType> CellOfWhole; ///< per polygon and strip; -1 where there is none

  vtkIdType Label(vtkIdType point) const
  {
    return vtkIdTypeArray::SafeDownCast(this->Data->GetPointData()->GetArray(LabelName))
      ->GetValue(point);
  }
  vtkIdType Id(vtkIdType point) const
  {
    return vtkIdTypeArray::SafeDownCast(this->Data->GetPointData()->GetGlobalIds())
      ->GetValue(point);
  }
};

struct GatheredSurfaces::Whole
{
  std::vector<Part> Parts; ///< ordered by process, within it as its pieces
  vtkIdType NumberOfLabels = 0;
  vtkSmartPointer<vtkPolyData> Data, Output;

  void Sew();

private:
  void SewPoints(vtkPolyData* sewn);
  void SewCells(vtkPolyData* sewn);
};

namespace
{

/// Where a point or cell of the whole comes from.
struct Source
{
  std::size_t Part;
  vtkIdType Index;
};

/// The arrays that all parts with any tuples have, each tuple from its source.
template <typename Part>
void SewArrays(const std::vector<Part>& parts, const std::vector<Source>& sources, bool ofCells,
  vtkDataSetAttributes* to)
{
  const auto attributesOf = [&](const Part& part) -> vtkDataSetAttributes*
  {
    return ofCells ? static_cast<vtkDataSetAttributes*>(part.Data->GetCellData())
                   : part.Data->GetPointData();
  };
  std::vector<const Part*> filled;
  for (const Part& part : parts)
  {
    if (ofCells ? part.Data->GetNumberOfCells() > 0 : part.NumberOfPoints > 0)
    {
      filled.push_back(&part);
    }
  }
  vtkDataSetAttributes* const first = filled.empty() ? nullptr : attributesOf(*filled.front());
  for (int a = 0; first && a < first->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* const model = first->GetAbstractArray(a);
    const std::string name = model->GetName() ? model->GetName() : "";
    if (name == LabelName || name == vtkDataSetAttributes::GhostArrayName() ||
      (ofCells && model == first->GetGlobalIds()))
    {
      continue;
    }
    std::vector<vtkAbstractArray*> from(parts.size(), nullptr);
    bool everywhere = true;
    for (const Part* part : filled)
    {
      vtkAbstractArray* const array = attributesOf(*part)->GetAbstractArray(name.c_str());
      everywhere = everywhere && array && array->GetDataType() == model->GetDataType() &&
        array->GetNumberOfComponents() == model->GetNumberOfComponents();
      from[part - parts.data()] = array;
    }
    if (!everywhere)
    {
      continue;
    }
    const auto sewn = MakeLike(model, static_cast<vtkIdType>(sources.size()));
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
      sewn->SetTuple(static_cast<vtkIdType>(i), sources[i].Index, from[sources[i].Part]);
    }
    const int index = to->AddArray(sewn);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      if (first->GetAbstractAttribute(type) == model)
      {
        to->SetActiveAttribute(index, type);
      }
    }
  }
}

} // namespace

GatheredSurfaces::GatheredSurfaces() = default;
GatheredSurfaces::~GatheredSurfaces() = default;

void GatheredSurfaces::Whole::Sew()
{
  vtkNew<vtkPolyData> sewn;
  this->SewPoints(sewn);
  this->SewCells(sewn);
  this->Data = sewn;
  for (Part& part : this->Parts)
  {
    part.Data = nullptr;
  }
}

void GatheredSurfaces::Whole::SewPoints(vtkPolyData* sewn)
{
  std::vector<Source> sources; // the points that stand for themselves
  bool anyDouble = false;
  for (std::size_t p = 0; p < this->Parts.size(); ++p)
  {
    const Part& part = this->Parts[p];
    for (vtkIdType i = 0; i < part.NumberOfPoints; ++i)
    {
      if (part.Label(i) == part.FirstLabel + i)
      {
        sources.push_back({ p, i });
      }
    }
    anyDouble =
      anyDouble || (part.NumberOfPoints > 0 && part.Data->GetPoints()->GetDataType() == VTK_DOUBLE);
  }
  const auto idOf = [&](const Source& source) { return this->Parts[source.Part].Id(source.Index); };
  std::stable_sort(sources.begin(), sources.end(),
    [&](const Source& a, const Source& b) { return idOf(a) < idOf(b); });

  vtkNew<vtkPoints> points;
  points->SetDataType(anyDouble ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(sources.size()));
  std::vector<vtkIdType> ofLabel(this->NumberOfLabels, -1);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const Part& part = this->Parts[sources[i].Part];
    points->SetPoint(static_cast<vtkIdType>(i), part.Data->GetPoint(sources[i].Index));
    ofLabel[part.FirstLabel + sources[i].Index] = static_cast<vtkIdType>(i);
  }
  sewn->SetPoints(points);
  for (Part& part : this->Parts)
  {
    part.PointOfWhole.resize(part.NumberOfPoints);
    for (vtkIdType i = 0; i < part.NumberOfPoints; ++i)
    {
      part.PointOfWhole[i] = ofLabel[part.Label(i)];
    }
  }
  SewArrays(this->Parts, sources, false, sewn->GetPointData());
}

void GatheredSurfaces::Whole::SewCells(vtkPolyData* sewn)
{
  constexpr unsigned char absent =
    vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
  struct Cell
  {
    bool Strip;
    vtkIdType Id; ///< where all parts have ids
    std::vector<vtkIdType> Points;
    Source From;
    bool operator<(const Cell& other) const
    {
      return std::tie(this->Strip, this->Id, this->Points) <
        std::tie(other.Strip, other.Id, other.Points);
    }
  };
  const bool haveIds = std::all_of(this->Parts.begin(), this->Parts.end(),
    [](const Part& part)
    { return part.Data->GetNumberOfCells() == 0 || part.Data->GetCellData()->GetGlobalIds(); });
  std::vector<Cell> cells, ghosts;
  for (std::size_t p = 0; p < this->Parts.size(); ++p)
  {
    Part& part = this->Parts[p];
    part.CellOfWhole.assign(part.Data->GetNumberOfCells(), -1);
    vtkUnsignedCharArray* const flags = part.Data->GetCellGhostArray();
    vtkIdType index = 0;
    for (vtkCellArray* array : { part.Data->GetPolys(), part.Data->GetStrips() })
    {
      const vtkIdType count = array ? array->GetNumberOfCells() : 0;
      for (vtkIdType c = 0; c < count; ++c, ++index)
      {
        vtkIdType size = 0;
        const vtkIdType* ids = nullptr;
        array->GetCellAtId(c, size, ids);
        Cell cell{ array == part.Data->GetStrips(),
          haveIds ? static_cast<vtkIdType>(
                      part.Data->GetCellData()->GetGlobalIds()->GetComponent(index, 0))
                  : 0,
          {}, { p, index } };
        for (vtkIdType i = 0; i < size; ++i)
        {
          // Bad ids stay bad: the filter tells them.
          const bool good = ids[i] >= 0 && ids[i] < part.NumberOfPoints;
          cell.Points.push_back(good ? part.PointOfWhole[ids[i]] : -1);
        }
        const bool ghost = flags && (flags->GetValue(index) & absent);
        (ghost ? ghosts : cells).push_back(std::move(cell));
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  vtkNew<vtkCellArray> polygons, strips;
  std::vector<Source> sources;
  for (const Cell& cell : cells)
  {
    (cell.Strip ? strips : polygons)
      ->InsertNextCell(static_cast<vtkIdType>(cell.Points.size()), cell.Points.data());
    this->Parts[cell.From.Part].CellOfWhole[cell.From.Index] =
      static_cast<vtkIdType>(sources.size());
    sources.push_back(cell.From);
  }
  sewn->SetPolys(polygons);
  sewn->SetStrips(strips);
  SewArrays(this->Parts, sources, true, sewn->GetCellData());

  // Ghost cells are copies of the cells with the same corners.
  std::map<std::vector<vtkIdType>, std::size_t> ofCorners;
  const auto corners = [](const Cell& cell)
  {
    std::vector<vtkIdType> sorted = cell.Points;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  for (std::size_t c = 0; !ghosts.empty() && c < cells.size(); ++c)
  {
    ofCorners.emplace(corners(cells[c]), c);
  }
  for (const Cell& ghost : ghosts)
  {
    const auto original = ofCorners.find(corners(ghost));
    if (original != ofCorners.end())
    {
      this->Parts[ghost.From.Part].CellOfWhole[ghost.From.Index] =
        static_cast<vtkIdType>(original->second);
    }
  }
}

//------------------------------------------------------------------------------------------------
void GatheredSurfaces::Update(const Processes& processes, const std::vector<SurfacePiece>& pieces,
  double tolerance, vtkAlgorithm* filter)
{
  const std::string key = KeyOf(filter, pieces, tolerance);
  if (!processes.Any(key != this->Key))
  {
    return;
  }
  this->Key.clear();
  this->Wholes.clear();
  this->Order.clear();
  const std::vector<PointIdentity> identities = FindIdentity(processes, pieces, tolerance);

  std::vector<double> headers; // of everybody's pieces
  constexpr std::size_t width = 6;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    vtkPolyData* const data = pieces[p].Input;
    for (const vtkIdType number :
      { static_cast<vtkIdType>(processes.Rank()), static_cast<vtkIdType>(pieces[p].Surface),
        identities[p].FirstLabel, data->GetNumberOfVerts() + data->GetNumberOfLines(),
        data->GetNumberOfCells(), data->GetNumberOfPoints() })
    {
      headers.push_back(static_cast<double>(number));
    }
  }
  headers = processes.GatherAll(headers);
  std::vector<std::unique_ptr<Whole>> wholes;
  vtkIdType labels = 0;
  std::size_t mine = 0;
  for (std::size_t h = 0; h < headers.size(); h += width)
  {
    Part part;
    part.Process = static_cast<int>(headers[h]);
    const auto surface = static_cast<std::size_t>(headers[h + 1]);
    part.FirstLabel = static_cast<vtkIdType>(headers[h + 2]);
    part.FirstCell = static_cast<vtkIdType>(headers[h + 3]);
    part.NumberOfCells = static_cast<vtkIdType>(headers[h + 4]);
    part.NumberOfPoints = static_cast<vtkIdType>(headers[h + 5]);
    labels = std::max(labels, part.FirstLabel + part.NumberOfPoints);
    if (part.Process == processes.Rank())
    {
      part.Data = Pack(filter, pieces[mine].Input, identities[mine]);
      ++mine;
      if (processes.Rank() != 0)
      {
        processes.Controller()->Send(part.Data, 0, PieceTag);
      }
    }
    else if (processes.Rank() == 0)
    {
      part.Data = vtkSmartPointer<vtkPolyData>::New();
      processes.Controller()->Receive(part.Data, part.Process, PieceTag);
    }
    if (processes.Rank() == 0)
    {
      wholes.resize(std::max(wholes.size(), surface + 1));
      if (!wholes[surface])
      {
        wholes[surface] = std::make_unique<Whole>();
      }
      this->Order.emplace_back(wholes[surface].get(), wholes[surface]->Parts.size());
      wholes[surface]->Parts.push_back(std::move(part));
    }
  }
  for (std::unique_ptr<Whole>& whole : wholes)
  {
    if (whole)
    {
      whole->NumberOfLabels = labels;
      this->Wholes.push_back(std::move(whole));
    }
  }
  this->Key = key;
}

std::vector<SurfacePiece> GatheredSurfaces::MakeOutputs()
{
  std::vector<SurfacePiece> outputs;
  const std::string key = std::exchange(this->Key, std::string()); // until no memory was short
  for (const std::unique_ptr<Whole>& whole : this->Wholes)
  {
    if (!whole->Data)
    {
      whole->Sew();
    }
  }
  this->Key = key;
  for (const std::unique_ptr<Whole>& whole : this->Wholes)
  {
    whole->Output = vtkSmartPointer<vtkPolyData>::New();
    whole->Output->ShallowCopy(whole->Data);
    outputs.push_back({ static_cast<int>(outputs.size()), whole->Data, whole->Output });
  }
  return outputs;
}

//------------------------------------------------------------------------------------------------
namespace
{

enum class Place
{
  PointData,
  CellData,
  Coordinates
};

/// What the filter added: an array, or the points where it moved them.
struct Result
{
  vtkSmartPointer<vtkDataArray> Array;
  Place At = Place::PointData;
  int Attribute = -1; ///< that the array became
};

std::vector<Result> FindResults(vtkPolyData* input, vtkPolyData* output)
{
  std::vector<Result> results;
  const auto compare = [&](vtkDataSetAttributes* before, vtkDataSetAttributes* after, Place at)
  {
    for (int a = 0; a < after->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = after->GetArray(a);
      if (array && before->GetArray(array->GetName()) != array)
      {
        results.push_back({ array, at, after->IsArrayAnAttribute(a) });
      }
    }
  };
  compare(input->GetPointData(), output->GetPointData(), Place::PointData);
  compare(input->GetCellData(), output->GetCellData(), Place::CellData);
  if (input->GetPoints() != output->GetPoints())
  {
    results.push_back({ output->GetPoints()->GetData(), Place::Coordinates });
  }
  return results;
}

/// The tuples of an array of the whole that belong to a part; zero where there is none.
vtkSmartPointer<vtkDataArray> Restrict(
  vtkDataArray* array, const std::vector<vtkIdType>& ofWhole, vtkIdType first, vtkIdType count)
{
  auto part = MakeLike(array, count);
  part->Fill(0.0);
  for (std::size_t i = 0; i < ofWhole.size(); ++i)
  {
    if (ofWhole[i] >= 0)
    {
      part->SetTuple(first + static_cast<vtkIdType>(i), ofWhole[i], array);
    }
  }
  return part;
}

void SendResults(
  vtkMultiProcessController* controller, int process, const std::vector<Result>& results)
{
  vtkMultiProcessStream stream;
  stream << static_cast<int>(results.size());
  for (const Result& result : results)
  {
    stream << static_cast<int>(result.At) << result.Attribute;
    const int components = result.Array->GetNumberOfComponents();
    stream << components;
    for (int k = 0; k < components; ++k)
    {
      const char* const name = result.Array->GetComponentName(k);
      stream << std::string(name ? name : "");
    }
  }
  controller->Send(stream, process, ResultTag);
  for (const Result& result : results)
  {
    const int type = result.Array->GetDataType();
    controller->Send(&type, 1, process, ResultTag);
    controller->Send(result.Array, process, ResultTag);
  }
}

std::vector<Result> ReceiveResults(vtkMultiProcessController* controller)
{
  vtkMultiProcessStream stream;
  controller->Receive(stream, 0, ResultTag);
  int count = 0;
  stream >> count;
  std::vector<Result> results(count);
  for (Result& result : results)
  {
    int at = 0;
    int components = 0;
    stream >> at >> result.Attribute >> components;
    result.At = static_cast<Place>(at);
    std::vector<std::string> names(components);
    for (std::string& name : names)
    {
      stream >> name;
    }
    int type = VTK_DOUBLE;
    controller->Receive(&type, 1, 0, ResultTag);
    result.Array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    controller->Receive(result.Array, 0, ResultTag);
    for (int k = 0; k < components; ++k)
    {
      if (!names[k].empty())
      {
        result.Array->SetComponentName(k, names[k].c_str());
      }
    }
  }
  return results;
}

void AddResults(const std::vector<Result>& results, vtkPolyData* output)
{
  for (const Result& result : results)
  {
    if (result.At == Place::Coordinates)
    {
      vtkNew<vtkPoints> points;
      points->SetData(result.Array);
      output->SetPoints(points);
      continue;
    }
    vtkDataSetAttributes* attributes = output->GetPointData();
    if (result.At == Place::CellData)
    {
      attributes = output->GetCellData();
    }
    const int index = attributes->AddArray(result.Array);
    if (result.Attribute >= 0)
    {
      attributes->SetActiveAttribute(index, result.Attribute);
    }
  }
}

} // namespace

void GatheredSurfaces::Scatter(const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  if (processes.Rank() != 0)
  {
    for (const SurfacePiece& piece : pieces)
    {
      AddResults(ReceiveResults(processes.Controller()), piece.Output);
    }
    return;
  }
  std::map<const Whole*, std::vector<Result>> found;
  for (const std::unique_ptr<Whole>& whole : this->Wholes)
  {
    if (whole->Output) // there was memory for all
    {
      found[whole.get()] = FindResults(whole->Data, whole->Output);
    }
    whole->Output = nullptr;
  }
  std::size_t mine = 0;
  for (const auto& [whole, number] : this->Order)
  {
    const Part& part = whole->Parts[number];
    std::vector<Result> results = found[whole];
    for (Result& result : results)
    {
      result.Array = result.At == Place::CellData
        ? Restrict(result.Array, part.CellOfWhole, part.FirstCell, part.NumberOfCells)
        : Restrict(result.Array, part.PointOfWhole, 0, part.NumberOfPoints);
    }
    if (part.Process == 0)
    {
      AddResults(results, pieces[mine++].Output);
    }
    else
    {
      SendResults(processes.Controller(), part.Process, results);
    }
  }
}

} // namespace SurfaceDiffusion
