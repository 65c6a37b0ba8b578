// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/FieldReader.h"

#include "Conversion/PointInput.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SourceInput.h"
#include "Conversion/SurfaceReader.h"
#include "Conversion/TupleRange.h"
#include "Distributed/ContentHash.h"
#include "Distributed/InterfacePoints.h"
#include "Run/FieldChecks.h"

#include "vtkDataArray.h"
#include "vtkPolyData.h"

#include <string>

namespace SurfaceDiffusion
{

namespace
{

Word NamedArray(const char* kind, vtkDataArray* array)
{
  return Word::Array(
    kind, array ? std::string(" \"") + (array->GetName() ? array->GetName() : "") + "\"" : "");
}

Word NameOfData(const InputFields& arrays)
{
  return NamedArray(arrays.DataAreTerms ? "DataTermArray" : "InputArray", arrays.Data.Values);
}

std::vector<char> ReadFlags(vtkDataArray* array)
{
  std::vector<char> flags;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    flags.push_back(array->GetComponent(i, 0) != 0.0);
  }
  return flags;
}

std::vector<double> ReadFactors(vtkDataArray* array)
{
  std::vector<double> factors;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    factors.push_back(array->GetComponent(i, 0));
  }
  return factors;
}

Points ReadDirections(vtkDataArray* array)
{
  Points vectors(array->GetNumberOfTuples(), 3);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTuple(i, vectors.row(i).data());
  }
  return vectors;
}

Values ReadRates(vtkDataArray* array, const TriangleCells& cells)
{
  Values rates(static_cast<Eigen::Index>(cells.Size()), 4);
  for (std::size_t t = 0; t < cells.Size(); ++t)
  {
    for (int k = 0; k < 4; ++k)
    {
      rates(static_cast<Eigen::Index>(t), k) = array->GetComponent(cells[t], k);
    }
  }
  RequireRates(rates, [&](Index t) { return cells[static_cast<std::size_t>(t)]; });
  return rates;
}

} // namespace

FieldSummary InputFields::Summarize() const
{
  FieldSummary summary;
  summary.Data = this->Data.Values != nullptr;
  if (summary.Data)
  {
    summary.DataComponents = NumberOfDataComponents(this->Data.Values, this->AlphaIsData);
    summary.DataName = NameOfData(*this);
  }
  if (this->Samples)
  {
    summary.Data = true;
    summary.DataComponents = static_cast<int>(this->Samples->Given.cols());
  }
  summary.Directions = this->Direction.Values != nullptr;
  summary.Fixed = this->Fixed.Values != nullptr;
  summary.Rates = this->Rates != nullptr;
  summary.DataAreTerms = this->DataAreTerms;
  summary.Sources = this->Sources != nullptr;
  summary.PathPoints = this->PathPoints != nullptr;
  summary.Speeds = this->Speeds.Values != nullptr;
  summary.AlongSpeeds = this->AlongSpeeds.Values != nullptr;
  summary.AcrossSpeeds = this->AcrossSpeeds.Values != nullptr;
  summary.StartTimes = this->StartTimes.Values != nullptr;
  summary.SlopeErrorComponents =
    this->SlopeErrors.Values ? this->SlopeErrors.Values->GetNumberOfComponents() : 0;
  return summary;
}

std::vector<vtkDataArray*> InputFields::List() const
{
  return { this->Data.Values, this->Mask.Values, this->Direction.Values, this->Fixed.Values,
    this->Rates, this->Fidelity.Values, this->Seeds.Values, this->Speeds.Values,
    this->AlongSpeeds.Values, this->AcrossSpeeds.Values, this->StartTimes.Values,
    this->SlopeErrors.Values, this->GlobalIds, this->Between, this->GivenCells };
}

unsigned int InputFields::Associations() const
{
  unsigned int bits = 0;
  for (const LocatedArray* const array : { &this->Data, &this->Mask, &this->Direction, &this->Fixed,
         &this->Fidelity, &this->Seeds, &this->Speeds, &this->AlongSpeeds, &this->AcrossSpeeds })
  {
    bits = 2 * bits + (array->OnCells ? 1 : 0);
  }
  return bits;
}

int NumberOfDataComponents(vtkDataArray* array, bool alphaIsData)
{
  const int components = array->GetNumberOfComponents();
  const bool hasAlpha = !alphaIsData && array->GetDataType() == VTK_UNSIGNED_CHAR &&
    (components == 2 || components == 4);
  return hasAlpha ? components - 1 : components;
}

Values ReadValues(vtkDataArray* array, bool alphaIsData)
{
  const int components = NumberOfDataComponents(array, alphaIsData);
  Values values(array->GetNumberOfTuples(), components);
  VisitTuples(array,
    [&](const auto& tuples)
    {
      for (vtkIdType i = 0; i < static_cast<vtkIdType>(tuples.size()); ++i)
      {
        const auto tuple = tuples[i];
        for (int k = 0; k < components; ++k)
        {
          values(i, k) = static_cast<double>(tuple[k]);
        }
      }
    });
  return values;
}

Fingerprint FingerprintFields(const InputFields& arrays)
{
  Fingerprint fingerprint;
  for (vtkDataArray* array : arrays.List())
  {
    AddArray(fingerprint, array, SMPParallelFor::Instance());
  }
  fingerprint.AddNumber(std::uint64_t{ arrays.Associations() });
  if (arrays.Samples)
  {
    AddSamples(fingerprint, *arrays.Samples);
  }
  for (const SourceShapes* const shapes : { arrays.Sources.get(), arrays.PathPoints.get() })
  {
    fingerprint.AddNumber(std::uint64_t{ shapes ? 1u : 0u });
    if (shapes)
    {
      AddSources(fingerprint, *shapes);
    }
  }
  fingerprint.AddNumber(std::uint64_t{ arrays.DataAreTerms ? 1u : 0u });
  return fingerprint;
}

Fields ReadFields(const InputFields& arrays, const TriangleCells& cells)
{
  const vtkIdType numberOfCells = arrays.Surface->GetNumberOfCells();
  Fields fields;
  if (vtkDataArray* const data = arrays.Data.Values)
  {
    fields.Data = { ReadValues(data, arrays.AlphaIsData), arrays.Data.OnCells };
    fields.DataName = NameOfData(arrays);
    fields.DataAreTerms = arrays.DataAreTerms;
    fields.DataAreBytes = data->GetDataType() == VTK_UNSIGNED_CHAR;
  }
  fields.Samples = arrays.Samples;
  fields.Mask = { ReadFlags(arrays.Mask.Values), arrays.Mask.OnCells };
  fields.Fixed = { ReadFlags(arrays.Fixed.Values), arrays.Fixed.OnCells };
  fields.FidelityFactors = { ReadFactors(arrays.Fidelity.Values), arrays.Fidelity.OnCells };
  fields.Seeds = AsLabels({ ReadFactors(arrays.Seeds.Values), arrays.Seeds.OnCells },
    NamedArray(arrays.NameOfSeeds, arrays.Seeds.Values));
  fields.Sources = arrays.Sources;
  fields.PathPoints = arrays.PathPoints;
  fields.Speeds = { ReadFactors(arrays.Speeds.Values), arrays.Speeds.OnCells };
  fields.AlongSpeeds = { ReadFactors(arrays.AlongSpeeds.Values), arrays.AlongSpeeds.OnCells };
  fields.AcrossSpeeds = { ReadFactors(arrays.AcrossSpeeds.Values), arrays.AcrossSpeeds.OnCells };
  fields.StartTimes = ReadFactors(arrays.StartTimes.Values);
  if (arrays.SlopeErrors.Values)
  {
    fields.SlopeErrors = ReadValues(arrays.SlopeErrors.Values, true);
  }
  fields.Between = ReadFlags(arrays.Between);
  for (vtkIdType c = 0; arrays.GivenCells && c < numberOfCells; ++c)
  {
    fields.GivenCells.push_back(static_cast<Index>(arrays.GivenCells->GetComponent(c, 0)));
  }
  if (fields.HasCells())
  {
    fields.NumberOfCells = static_cast<Index>(numberOfCells);
    fields.Cells.resize(cells.Size());
    for (std::size_t t = 0; t < cells.Size(); ++t)
    {
      fields.Cells[t] = cells[t];
    }
  }
  if (arrays.Direction.Values)
  {
    fields.Directions = { ReadDirections(arrays.Direction.Values), arrays.Direction.OnCells };
    RequireFiniteDirections(fields.Directions.Values, fields.Directions.OnCells,
      NamedArray("DirectionArray", arrays.Direction.Values));
    if (fields.Directions.OnCells)
    {
      const Points ofCells = fields.Directions.Values;
      fields.Directions.Values.resize(static_cast<Eigen::Index>(cells.Size()), 3);
      for (std::size_t t = 0; t < cells.Size(); ++t)
      {
        fields.Directions.Values.row(static_cast<Eigen::Index>(t)) = ofCells.row(cells[t]);
      }
    }
  }
  if (arrays.Rates)
  {
    fields.Rates = ReadRates(arrays.Rates, cells);
  }
  if (arrays.GlobalIds)
  {
    fields.MakeIds = [ids = AsIdTypeArray(arrays.GlobalIds)]
    {
      const vtkIdType* const first = ids->GetPointer(0);
      return std::vector<std::int64_t>(first, first + ids->GetNumberOfTuples());
    };
  }
  return fields;
}

} // namespace SurfaceDiffusion
