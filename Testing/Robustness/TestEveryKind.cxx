// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every kind of run keeps to: its times, values that are held, values that are missing, the
// type of its data, natural units, and composite data.

#include "Twins.h"

#include "vtkAppendPolyData.h"
#include "vtkMultiBlockDataSet.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

using namespace FilterTest;

namespace
{

using Change = std::function<void(vtkPolyDataAlgorithm*)>;

class EveryKind : public testing::TestWithParam<FilterKind>
{
protected:
  EveryKind()
  {
    AddRough(this->Surface);
    AddArraysOfAllFilters(this->Surface);
  }

  vtkSmartPointer<vtkPolyDataAlgorithm> Run(
    vtkDataObject* input, const Change& change = [](vtkPolyDataAlgorithm*) {}) const
  {
    auto filter = this->GetParam().Make();
    filter->SetInputDataObject(input);
    change(filter);
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors, std::vector<std::string>());
    return filter;
  }

  std::string DataName() const { return DiffusedArray(this->GetParam()); }
  bool IsOnCells() const { return this->DataName() == "c"; }
  vtkDataSetAttributes* Attributes(vtkPolyData* surface) const
  {
    return surface->GetAttributes(this->IsOnCells() ? vtkDataObject::CELL : vtkDataObject::POINT);
  }
  vtkDataArray* Data() const
  {
    return this->Attributes(this->Surface)->GetArray(this->DataName().c_str());
  }
  /// Whether the value of a point or cell has weight 0, so that it may be filled in.
  bool IsWeightless(vtkIdType i) const
  {
    return WeightOf(i) == 0.0 && HasInputArray(this->GetParam().Make(), 5);
  }
  template <typename Value>
  void Add(const char* name, int components, Value&& value, int type = VTK_DOUBLE) const
  {
    this->Attributes(this->Surface)
      ->AddArray(MakeArray(type, name, this->Data()->GetNumberOfTuples(), components, value));
  }
  /// Adds the bytes "rgba" that follow the data, with an alpha.
  vtkDataArray* AddBytes() const
  {
    const auto data = Copy(this->Data());
    const double scale = data->GetDataType() == VTK_UNSIGNED_CHAR ? 1.0 : 80.0;
    this->Add(
      "rgba", 4,
      [&](vtkIdType i, int k)
      { return k == 3 ? i % 256 : std::clamp(scale * (data->GetComponent(i, 0) + k), 0.0, 255.0); },
      VTK_UNSIGNED_CHAR);
    return this->Attributes(this->Surface)->GetArray("rgba");
  }
  /// The result of a run on one of these arrays.
  vtkSmartPointer<vtkDataArray> ResultOf(
    const char* array, const char* mask, const Change& change = [](vtkPolyDataAlgorithm*) {}) const
  {
    const auto filter = this->Run(this->Surface,
      [&](vtkPolyDataAlgorithm* f)
      {
        change(f);
        SetInputArray(f, 0, array, this->IsOnCells());
        SetInputArray(f, 1, mask, this->IsOnCells());
        vtkSurfaceModelAlgorithm::SafeDownCast(f)->SetMaskMode(0);
        vtkSurfaceFilter::SafeDownCast(f)->SetResultArrayName("result");
      });
    return this->Attributes(filter->GetOutput())->GetArray("result");
  }

  const vtkSmartPointer<vtkPolyData> Surface = Sphere(this->GetParam().Levels(4));
};

class EveryKindWithData : public EveryKind
{
};

class EveryKindWithTimes : public EveryKind
{
};

class EveryKindOfParts : public EveryKind
{
};

std::vector<FilterKind> KindsWith(const std::function<bool(const FilterKind&)>& property)
{
  std::vector<FilterKind> kinds;
  for (const FilterKind& kind : AllFilters())
  {
    if (property(kind))
    {
      kinds.push_back(kind);
    }
  }
  return kinds;
}

/// Kinds of runs that diffuse an array.
std::vector<FilterKind> KindsWithData()
{
  return KindsWith(
    [](const FilterKind& kind)
    {
      const bool isModel = vtkSurfaceModelAlgorithm::SafeDownCast(kind.Make()) != nullptr;
      return isModel && !DiffusedArray(kind).empty();
    });
}

/// Kinds of runs that find nothing, such as a weight or a mean, from all data of a surface.
std::vector<FilterKind> KindsOfParts()
{
  return KindsWith(
    [](const FilterKind& kind)
    {
      const std::string name = kind.Name;
      bool finds = name.find("MumfordShah") == 0 && name != "MumfordShahGiven";
      for (const char* const found :
        { "Automatic", "Found", "CoarseStart", "Segmentation", "Direction", "Interpolation",
          "DistanceHeat", // of one mean length of edges
          "DistanceEikonal", "ArrivalTime", // round-off decides between fronts that arrive together
          "ConductionVelocity" }) // the inverse of gradients, in which round-off may be large
      {
        finds = finds || name.find(found) != std::string::npos;
      }
      return !finds;
    });
}

/// Kinds of runs that publish times.
std::vector<FilterKind> KindsWithTimes()
{
  return KindsWith(
    [](const FilterKind& kind)
    {
      const auto made = kind.Make();
      auto* const diffusion = vtkSurfaceDiffusionAlgorithm::SafeDownCast(made);
      if (!diffusion)
      {
        return false;
      }
      diffusion->GenerateTimeStepsOn();
      made->SetInputData(Sphere(1));
      return !PublishedTimes(made).empty();
    });
}

bool IsMarked(vtkIdType i)
{
  return i % 7 == 3;
}

/// The factor of the energy for lengths and values of these factors.
double EnergyScale(const FilterKind& kind, double length, double value)
{
  const std::pair<std::string, double> scales[] = {
    { "Heat", value * value }, // int |grad u|^2
    { "TV", length * value }, // int |grad u|
    { "PeronaMalik", value * value }, { "Harmonic", length }, // int |grad n|
    { "MumfordShah", value * value }, { "Beltrami", value * value },
    { "CoherenceEnhancing", length * length * value * value }, // int u^2
    { "EdgeEnhancing", length * length * value * value }, { "Turing", length * length },
    { "Segmentation", length }, // of boundaries
  };
  for (const auto& [name, scale] : scales)
  {
    if (std::string(kind.Name).rfind(name, 0) == 0)
    {
      return scale;
    }
  }
  ADD_FAILURE() << kind.Name << " has an energy that is not listed";
  return 0.0;
}

/// Lengths and values in the units of the input, not in natural ones.
/// Whether the data are cyclic, so that their bits go through sines and have no unit.
bool IsPeriodic(const FilterKind& kind)
{
  const auto filter = kind.Make();
  auto* const heat = vtkFVMHeatFilter::SafeDownCast(filter);
  return heat && heat->GetPeriod() > 0.0;
}

template <typename Filter>
void ScaleUnits(vtkPolyDataAlgorithm* filter, double length, double value)
{
  if (auto* f = Filter::SafeDownCast(filter))
  {
    f->SetBlurFWHM(length * f->GetBlurFWHM());
    f->SetNoiseLevel(value * f->GetNoiseLevel());
  }
}

} // namespace

TEST_P(EveryKindWithTimes, HasTheBitsOfEachTimeInAnyOrderOfRequests)
{
  const auto make = [this](bool timeSteps)
  {
    auto made = this->GetParam().Make();
    if (auto* diffusion = vtkSurfaceDiffusionAlgorithm::SafeDownCast(made))
    {
      diffusion->SetGenerateTimeSteps(timeSteps);
      diffusion->SetCheckpointMemoryLimit(0); // going back repeats steps
    }
    made->SetInputData(this->Surface);
    return made;
  };
  const auto seeking = make(true);
  const std::vector<double> times = PublishedTimes(seeking);
  ASSERT_GE(times.size(), 2u);
  const double last = times.back();
  for (const double time : { last, 0.0, last, times[1], 0.0, times[times.size() - 2], last })
  {
    const auto direct = make(true);
    UpdateAt(direct, time);
    UpdateAt(seeking, time);
    EXPECT_EQ(Difference(seeking, direct), "") << time;
  }
  const auto without = make(false);
  without->Update();
  EXPECT_EQ(Difference(seeking, without), "");
}

TEST_P(EveryKindWithData, KeepsTheBitsOfFixedHeldAndExcludedValues)
{
  if (IsPeriodic(this->GetParam()))
  {
    return;
  }
  this->Add("marks", 1, [](vtkIdType i, int) { return IsMarked(i); });
  const std::pair<const char*, Change> cases[] = {
    { "fixed", [](auto* f) { SetInputArray(f, 1, ""); } },
    { "held",
      [](auto* f) { vtkSurfaceDataDiffusionAlgorithm::SafeDownCast(f)->HoldKnownValuesOn(); } },
    { "excluded", [](auto* f) { vtkSurfaceModelAlgorithm::SafeDownCast(f)->SetMaskMode(1); } },
  };
  for (const auto& [name, change] : cases)
  {
    const bool held = std::string(name) == "held";
    if (std::string(name) != "excluded" &&
      !vtkSurfaceDataDiffusionAlgorithm::SafeDownCast(this->GetParam().Make()))
    {
      continue; // it has neither
    }
    const auto filter = this->Run(this->Surface,
      [&, set = change](vtkPolyDataAlgorithm* f)
      {
        vtkSurfaceModelAlgorithm::SafeDownCast(f)->SetMaskMode(0);
        SetInputArray(f, std::string(name) == "fixed" ? 3 : 1, "marks", this->IsOnCells());
        set(f);
      });
    vtkDataArray* const result = FilterTest::ResultOf(filter, this->GetParam().Result);
    ASSERT_NE(result, nullptr) << name;
    bool changed = false;
    for (vtkIdType i = 0; i < result->GetNumberOfTuples(); ++i)
    {
      for (int k = 0; k < result->GetNumberOfComponents(); ++k)
      {
        const bool same = result->GetComponent(i, k) == this->Data()->GetComponent(i, k);
        const bool fills = held && this->IsWeightless(i); // such a value is not known
        EXPECT_TRUE(same || IsMarked(i) == held || fills) << name << ' ' << i;
        changed = changed || !same;
      }
    }
    EXPECT_TRUE(changed) << name;
  }
}

TEST_P(EveryKindWithData, ReadsNoMissingValue)
{
  const auto data = Copy(this->Data());
  const auto with = [&](double missing)
  {
    return [&data, missing](vtkIdType i, int k)
    { return IsMarked(i) && k == 0 ? missing : data->GetComponent(i, k); };
  };
  this->Add("marks", 1, [](vtkIdType i, int) { return IsMarked(i); });
  this->Add("damaged", data->GetNumberOfComponents(), with(-1e4));
  this->Add("holed", data->GetNumberOfComponents(), with(vtkMath::Nan()));
  const auto expected = this->ResultOf("damaged", "marks");
  EXPECT_TRUE(Identical(this->ResultOf("holed", "marks"), expected));
  EXPECT_TRUE(Identical(this->ResultOf("holed", ""), expected)); // NaN in a component is missing
}

TEST_P(EveryKindWithData, KeepsBytesAndTheirAlpha)
{
  vtkDataArray* const rgba = this->AddBytes();
  const auto result = this->ResultOf("rgba", "");
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(result->GetDataType(), VTK_UNSIGNED_CHAR);
  ASSERT_EQ(result->GetNumberOfComponents(), 4);
  for (vtkIdType i = 0; i < result->GetNumberOfTuples(); ++i)
  {
    ASSERT_EQ(result->GetComponent(i, 3), rgba->GetComponent(i, 3)) << i;
  }
}

TEST_P(EveryKindWithTimes, StartsFromTheBitsOfItsData)
{
  if (this->DataName().empty() || IsPeriodic(this->GetParam()))
  {
    return;
  }
  const auto before = [](vtkPolyDataAlgorithm* f)
  { vtkSurfaceDiffusionAlgorithm::SafeDownCast(f)->SetNumberOfTimeSteps(0); };
  for (vtkDataArray* const given : { this->Data(), this->AddBytes() })
  {
    const auto result = this->ResultOf(given->GetName(), "", before);
    const auto expected = Copy(given);
    for (vtkIdType i = 0; i < given->GetNumberOfTuples(); ++i)
    {
      if (this->IsWeightless(i))
      {
        expected->SetTuple(i, i, result);
      }
    }
    EXPECT_TRUE(Identical(result, expected)) << given->GetName();
  }
}

/// Powers of two scale every number without rounding.
TEST_P(EveryKind, HasTheSameBitsAtAnySizeInNaturalUnits)
{
  if (IsPeriodic(this->GetParam()))
  {
    return;
  }
  constexpr double length = 64.0, value = 16.0;
  vtkSmartPointer<vtkPolyDataAlgorithm> filters[2];
  for (const bool scaled : { false, true })
  {
    vtkNew<vtkPolyData> surface;
    surface->DeepCopy(this->Surface);
    vtkDataArray* const points = surface->GetPoints()->GetData();
    for (vtkIdType i = 0; scaled && i < points->GetNumberOfValues(); ++i)
    {
      points->SetComponent(i / 3, i % 3, length * points->GetComponent(i / 3, i % 3));
    }
    for (vtkDataSetAttributes* attributes :
      { surface->GetAttributes(vtkDataObject::POINT), surface->GetAttributes(vtkDataObject::CELL) })
    {
      for (const char* name : { "f", "rgb", "c", "e1" })
      {
        if (vtkDataArray* const given = attributes->GetArray(name))
        {
          attributes->AddArray(
            MakeArray(VTK_DOUBLE, name, given->GetNumberOfTuples(), given->GetNumberOfComponents(),
              [&](vtkIdType i, int k)
              { return (scaled ? value : 1.0) * given->GetComponent(i, k); }));
        }
      }
    }
    surface->GetPointData()->SetActiveScalars("f");
    surface->GetPointData()->SetGlobalIds(MakeArray(VTK_ID_TYPE, "ids",
      surface->GetNumberOfPoints(), 1, [](vtkIdType i, int) { return i; })); // of the noise
    filters[scaled] = this->Run(surface,
      [&](vtkPolyDataAlgorithm* f)
      {
        ScaleUnits<vtkFVMHeatFilter>(f, scaled ? length : 1.0, scaled ? value : 1.0);
        ScaleUnits<vtkIntrinsicTVFilter>(f, scaled ? length : 1.0, scaled ? value : 1.0);
        auto* const relief = vtkSurfaceReliefFilter::SafeDownCast(f);
        if (relief && scaled)
        {
          const bool two = relief->GetLevels() == vtkSurfaceReliefFilter::LEVELS_TWO;
          relief->SetHeight(relief->GetHeight() * length / (two ? 1.0 : value));
          relief->SetBase(relief->GetBase() * length);
          relief->SetThreshold(relief->GetThreshold() * value);
          relief->SetFlank(relief->GetFlank() * length);
        }
        if (auto* curvature = vtkSurfaceCurvatureFilter::SafeDownCast(f))
        {
          curvature->SetFWHM((scaled ? length : 1.0) * curvature->GetFWHM());
        }
        if (auto* field = vtkSurfaceRandomFieldFilter::SafeDownCast(f))
        {
          field->SetFWHM((scaled ? length : 1.0) * field->GetFWHM());
          field->SetRange((scaled ? length : 1.0) * field->GetRange());
        }
        if (auto* denoising = vtkSurfaceDenoisingFilter::SafeDownCast(f))
        {
          denoising->SetNoiseLevel((scaled ? length : 1.0) * denoising->GetNoiseLevel());
          denoising->SetDisplacementLimit(
            (scaled ? length : 1.0) * denoising->GetDisplacementLimit());
        }
        if (auto* derivatives = vtkSurfaceDerivativesFilter::SafeDownCast(f))
        {
          derivatives->SetSmoothingFWHM((scaled ? length : 1.0) * derivatives->GetSmoothingFWHM());
        }
      });
  }
  const std::string name = this->GetParam().Result;
  const std::map<std::string, double> factors = { { "Displacement", length },
    { "ReliefHeight", length }, { "MeanCurvature", 1.0 / length }, { "fGradient", value / length },
    { "fConductionVelocity", length / value }, { "Distance", length },
    { "ArrivalTime", length / value }, { "e1GradientPotential", length * value },
    { "e1Diffused", value } };
  const double usual = this->DataName().empty() ? 1.0 : value;
  const double factor = factors.count(name) > 0 ? factors.at(name) : usual;
  vtkDataArray* const expected = FilterTest::ResultOf(filters[0], name.c_str());
  vtkDataArray* const result = FilterTest::ResultOf(filters[1], name.c_str());
  ASSERT_TRUE(expected && result);
  const auto scaled =
    MakeArray(VTK_DOUBLE, "", expected->GetNumberOfTuples(), expected->GetNumberOfComponents(),
      [&](vtkIdType i, int k) { return factor * expected->GetComponent(i, k); });
  // The search for the weight of total variation takes logarithms of it.
  auto* const tv = vtkIntrinsicTVFilter::SafeDownCast(filters[0]);
  const bool found = tv && tv->GetEffectiveFidelityWeight() != tv->GetFidelityWeight();
  const double allowed = found ? 1e-12 : 0.0;
  EXPECT_LE(LargestDifference(result, scaled), allowed);
  if (filters[0]->GetNumberOfOutputPorts() > 1 && History(filters[0]) &&
    History(filters[0])->GetColumnByName("Energy"))
  {
    const double ratio = EnergyScale(this->GetParam(), length, value);
    for (vtkIdType row = 0; row < History(filters[0])->GetNumberOfRows(); ++row)
    {
      const double energy = HistoryAt(filters[1], row, "Energy");
      EXPECT_NEAR(energy, ratio * HistoryAt(filters[0], row, "Energy"), allowed * energy);
      if (History(filters[0])->GetColumnByName("ErrorBound"))
      {
        const double bound = value * HistoryAt(filters[0], row, "ErrorBound");
        EXPECT_NEAR(HistoryAt(filters[1], row, "ErrorBound"), bound, (found ? 1e-5 : 0.0) * bound);
      }
    }
  }
  if (std::string(this->GetParam().Name) == "MumfordShahGiven") // finds edges
  {
    const auto edgeLength = [&](int i)
    { return vtkMumfordShahFilter::SafeDownCast(filters[i])->GetEdgeLength(); };
    EXPECT_GT(edgeLength(0), 0.0);
    EXPECT_EQ(edgeLength(1), length * edgeLength(0));
  }
}

/// Blocks share their units, those of all parts together.
TEST_P(EveryKindOfParts, TreatsUnequalBlocksAsItDoesPartsOfOneSurface)
{
  vtkNew<vtkPolyData> other;
  other->DeepCopy(this->Surface);
  vtkDataArray* const points = other->GetPoints()->GetData();
  for (vtkIdType i = 0; i < points->GetNumberOfValues(); ++i)
  {
    points->SetComponent(i / 3, i % 3, 2.5 * points->GetComponent(i / 3, i % 3) + 7.0);
  }
  for (vtkDataArray* const data : { other->GetPointData()->GetArray("f"),
         other->GetPointData()->GetArray("rgb"), other->GetCellData()->GetArray("c") })
  {
    for (vtkIdType i = 0; i < data->GetNumberOfTuples(); ++i)
    {
      data->SetComponent(i, 0, 0.3 * data->GetComponent(data->GetNumberOfTuples() - 1 - i, 0));
    }
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkAppendPolyData> append;
  for (vtkPolyData* const part : { this->Surface.Get(), other.Get() })
  {
    blocks->SetBlock(blocks->GetNumberOfBlocks(), part);
    append->AddInputData(part);
  }
  append->Update();
  const auto exactly = [](vtkPolyDataAlgorithm* f)
  {
    if (auto* const diffusion = vtkSurfaceDiffusionAlgorithm::SafeDownCast(f))
    {
      diffusion->SetTolerance(1e-12);
    }
    if (auto* const tv = vtkIntrinsicTVFilter::SafeDownCast(f))
    {
      tv->SetStopTolerance(1e-8);
    }
  };
  const auto apart = this->Run(blocks, exactly);
  const auto together = this->Run(append->GetOutput(), exactly);
  const auto whole = FilterTest::ResultOf(together, this->GetParam().Result);
  ASSERT_NE(whole, nullptr);
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(apart->GetOutputDataObject(0));
  double largest = 0.0;
  vtkIdType row = 0;
  for (unsigned int b = 0; b < 2; ++b)
  {
    vtkPolyData* const block = vtkPolyData::SafeDownCast(output->GetBlock(b));
    vtkDataArray* result = block->GetPointData()->GetArray(this->GetParam().Result.c_str());
    result = result ? result : block->GetCellData()->GetArray(this->GetParam().Result.c_str());
    ASSERT_NE(result, nullptr);
    for (vtkIdType i = 0; i < result->GetNumberOfTuples(); ++i, ++row)
    {
      for (int k = 0; k < result->GetNumberOfComponents(); ++k)
      {
        largest =
          std::max(largest, std::abs(result->GetComponent(i, k) - whole->GetComponent(row, k)));
      }
    }
  }
  // Minimisers end when the energy of all parts is within a tolerance.
  auto* const harmonic = vtkHarmonicMapFilter::SafeDownCast(apart);
  const bool isMinimiser = vtkIntrinsicTVFilter::SafeDownCast(apart) ||
    (harmonic && harmonic->GetScheme() == vtkHarmonicMapFilter::SCHEME_MINIMIZING_MOVEMENT);
  // Variances are differences of inverses, of which round-off takes nine digits.
  const bool isField = vtkSurfaceRandomFieldFilter::SafeDownCast(apart) != nullptr;
  EXPECT_LE(largest, isMinimiser ? 1e-4 : isField ? 1e-6 : 1e-11);
}

TEST_P(EveryKindWithTimes, AgreesForAllSolvers)
{
  vtkSmartPointer<vtkDataArray> first;
  for (const int solver : { vtkSurfaceDiffusionAlgorithm::SOLVER_DIRECT,
         vtkSurfaceDiffusionAlgorithm::SOLVER_CONJUGATE_GRADIENT,
         vtkSurfaceDiffusionAlgorithm::SOLVER_MULTIGRID })
  {
    const auto filter = this->Run(this->Surface,
      [solver](vtkPolyDataAlgorithm* f)
      {
        auto* const diffusion = vtkSurfaceDiffusionAlgorithm::SafeDownCast(f);
        diffusion->SetSolver(solver);
        diffusion->SetTolerance(1e-10);
      });
    const auto result = Copy(FilterTest::ResultOf(filter, this->GetParam().Result));
    first = first ? first : result;
    EXPECT_LE(LargestDifference(first, result), 1e-7) << solver;
  }
}

TEST_P(EveryKind, TreatsEqualBlocksAsItDoesOneSurface)
{
  const auto alone = this->Run(this->Surface);
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (unsigned int b = 0; b < 2; ++b)
  {
    vtkNew<vtkPolyData> copy;
    copy->DeepCopy(this->Surface);
    blocks->SetBlock(b, copy);
  }
  const auto both = this->Run(blocks);
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(both->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  for (unsigned int b = 0; b < 2; ++b)
  {
    vtkPolyData* const block = vtkPolyData::SafeDownCast(output->GetBlock(b));
    ASSERT_NE(block, nullptr);
    vtkPolyData* const one = alone->GetOutput();
    EXPECT_TRUE(SameValues(block->GetPoints()->GetData(), one->GetPoints()->GetData()));
    EXPECT_EQ(DifferentArrays(block->GetPointData(), one->GetPointData()), "") << b;
    EXPECT_EQ(DifferentArrays(block->GetCellData(), one->GetCellData()), "") << b;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, testing::ValuesIn(AllFilters()), KindName);
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKindWithData, testing::ValuesIn(KindsWithData()), KindName);
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKindWithTimes, testing::ValuesIn(KindsWithTimes()), KindName);
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKindOfParts, testing::ValuesIn(KindsOfParts()), KindName);
