// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Solves by domain decomposition: each process with its own piece, with hypre.
#include "Pieces.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMumfordShahFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include "vtkCellData.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace Pieces;

namespace
{

constexpr int N = 24;

/// A piece with ids, vectors and a mask that do not depend on the decomposition. sheared: with
/// obtuse angles.
vtkSmartPointer<vtkPolyData> WithData(vtkSmartPointer<vtkPolyData> piece, bool sheared = false)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
  {
    double x[3];
    piece->GetPoint(i, x);
    ids->InsertNextValue(std::lround(x[0] * N) * (N + 1) + std::lround(x[1] * N));
    x[0] += sheared ? -0.8 * x[1] : 0.0;
    piece->GetPoints()->SetPoint(i, x);
  }
  piece->GetPointData()->SetGlobalIds(ids);
  AddPointArray(piece, "v", 3,
    [&](vtkIdType i, int k) { return (k == 0 ? 0.5 : 0.0) + Rough(ids->GetValue(i), k); });
  AddPointArray(piece, "rough", 1, [&](vtkIdType i, int k) { return Rough(ids->GetValue(i), k); });
  AddPointArray(piece, "hole", 1,
    [&](vtkIdType i, int)
    {
      const double* x = piece->GetPoint(i);
      return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.3 ? 1.0 : 0.0;
    });
  AddPointArray(
    piece, "edge", 1, [&](vtkIdType i, int) { return piece->GetPoint(i)[1] == 0.0 ? 1.0 : 0.0; });
  return piece;
}

vtkSmartPointer<vtkFVMHeatFilter> MakeHeat()
{
  auto heat = vtkSmartPointer<vtkFVMHeatFilter>::New();
  heat->SetInputData(Mine(N));
  SetInputArray(heat, 0, "f");
  return heat;
}

template <typename Filter>
vtkSmartPointer<Filter> Make(const char* array, int steps)
{
  auto filter = vtkSmartPointer<Filter>::New();
  SetInputArray(filter, 0, array);
  filter->SetNumberOfTimeSteps(steps);
  filter->SetSolverToConjugateGradient();
  filter->SetTolerance(1e-12);
  return filter;
}

using AnyFilter = vtkSmartPointer<vtkSurfaceDiffusionAlgorithm>;

/// A filter and its result array.
struct Case
{
  const char* Name;
  const char* Result;
  AnyFilter (*Make)();
  double Tolerance = 1e-9;
};

std::ostream& operator<<(std::ostream& os, const Case& of)
{
  return os << of.Name;
}

AnyFilter Turing()
{
  return Make<vtkTuringTextureFilter>("", 20);
}

AnyFilter TuringFirstOrder()
{
  auto turing = Make<vtkTuringTextureFilter>("", 20);
  turing->SetTimeIntegratorToFirstOrder();
  turing->SetInitialNoise(0.9);
  return turing;
}

AnyFilter TuringUntilStationary()
{
  auto turing = Make<vtkTuringTextureFilter>("", 300);
  turing->SetStopTolerance(0.3);
  return turing;
}

AnyFilter TuringMultigrid()
{
  auto turing = Make<vtkTuringTextureFilter>("", 5);
  turing->SetSolverToMultigrid();
  return turing;
}

AnyFilter Harmonic()
{
  return Make<vtkHarmonicMapFilter>("v", 5);
}

AnyFilter HarmonicLongSteps()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 3);
  map->SetTimeStep(100.0);
  map->SetExponent(2.0);
  return map;
}

AnyFilter HarmonicMultigrid()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 3);
  map->SetSolverToMultigrid();
  map->SetTimeStep(20.0);
  return map;
}

AnyFilter HarmonicInpainting()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 5);
  SetInputArray(map, 1, "hole");
  SetInputArray(map, 3, "edge");
  map->SetFidelityWeight(0.2);
  return map;
}

AnyFilter HarmonicLines()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 5);
  map->SetLineField(true);
  return map;
}

AnyFilter HarmonicPaper()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 5);
  map->UsePaperScheme();
  SetInputArray(map, 3, "edge");
  return map;
}

AnyFilter HarmonicMinimizingMovement()
{
  auto map = Make<vtkHarmonicMapFilter>("v", 2);
  map->SetSchemeToMinimizingMovement();
  return map;
}

AnyFilter Edges()
{
  auto shah = Make<vtkMumfordShahFilter>("v", 12);
  shah->EdgeCurvesOff();
  shah->SetEdgeThreshold(0.8);
  return shah;
}

AnyFilter EdgesInpainting()
{
  auto shah = Make<vtkMumfordShahFilter>("rough", 12);
  SetInputArray(shah, 1, "hole");
  SetInputArray(shah, 3, "edge");
  shah->EdgeCurvesOff();
  return shah;
}

AnyFilter Beltrami()
{
  return Make<vtkTensorDiffusionFilter>("v", 5);
}

AnyFilter BeltramiInpainting()
{
  auto tensor = Make<vtkTensorDiffusionFilter>("rough", 5);
  SetInputArray(tensor, 1, "hole");
  SetInputArray(tensor, 3, "edge");
  tensor->SetFidelityWeight(0.2);
  tensor->SetMetricToFixed();
  return tensor;
}

AnyFilter EdgeEnhancing()
{
  auto tensor = Make<vtkTensorDiffusionFilter>("v", 5);
  tensor->SetModelToEdgeEnhancing();
  return tensor;
}

AnyFilter Minimum()
{
  auto tv = Make<vtkIntrinsicTVFilter>("f", 1);
  tv->SetModeToSteadyState();
  tv->SetFidelityWeight(0.3);
  tv->SetStopTolerance(1e-7);
  return tv;
}

AnyFilter MinimumInpainting()
{
  auto tv = Make<vtkIntrinsicTVFilter>("rough", 1);
  tv->SetModeToSteadyState();
  tv->SetEdgeFunctionToCharbonnier();
  SetInputArray(tv, 1, "hole");
  SetInputArray(tv, 3, "edge");
  tv->SetHoldKnownValues(true);
  return tv;
}

AnyFilter MinimumL1()
{
  auto tv = Make<vtkIntrinsicTVFilter>("v", 1);
  tv->SetModeToSteadyState();
  tv->SetFidelityNormToL1();
  tv->SetFidelityWeight(2.0);
  return tv;
}

AnyFilter ImplicitSteps()
{
  auto tv = Make<vtkIntrinsicTVFilter>("rough", 4);
  tv->SetTimeIntegratorToImplicit();
  tv->SetStopTolerance(1e-7); // the penalty may grow at another iteration
  return tv;
}

AnyFilter Heat()
{
  return Make<vtkFVMHeatFilter>("f", 5);
}

/// The largest difference from the result of a single process, at points of equal ids, over all
/// processes.
double LargestDifference(vtkPolyData* mine, vtkPolyData* whole, const char* name)
{
  vtkDataArray* const here = mine->GetPointData()->GetArray(name);
  vtkDataArray* const there = whole->GetPointData()->GetArray(name);
  double largest = here && there ? 0.0 : VTK_DOUBLE_MAX;
  std::map<double, vtkIdType> pointOf;
  for (vtkIdType i = 0; i < whole->GetNumberOfPoints(); ++i)
  {
    pointOf[whole->GetPointData()->GetGlobalIds()->GetComponent(i, 0)] = i;
  }
  for (vtkIdType i = 0; largest == 0.0 && i < mine->GetNumberOfPoints(); ++i)
  {
    const vtkIdType same = pointOf[mine->GetPointData()->GetGlobalIds()->GetComponent(i, 0)];
    for (int k = 0; k < here->GetNumberOfComponents(); ++k)
    {
      const double difference = std::abs(here->GetComponent(i, k) - there->GetComponent(same, k));
      largest = difference <= largest ? largest : difference;
    }
  }
  return OfAll(largest, vtkCommunicator::MAX_OP);
}

} // namespace

class Together : public testing::TestWithParam<Case>
{
};

TEST_P(Together, GiveTheResultOfTheWholeSurface)
{
  for (const bool sheared : { false, true })
  {
    auto filter = GetParam().Make();
    filter->SetInputData(WithData(Mine(N), sheared));
    bool workedHere = false; // if surfaces are gathered, only process 0 computes
    Listen(
      filter, [&](double amount) { workedHere = workedHere || (amount > 0.0 && amount < 1.0); });
    filter->Update();
    EXPECT_TRUE(workedHere);

    auto alone = GetParam().Make();
    alone->SetController(nullptr);
    alone->SetInputData(WithData(Strip(0, N, N), sheared));
    alone->Update();
    const double difference =
      LargestDifference(filter->GetOutput(), alone->GetOutput(), GetParam().Result);
    EXPECT_LT(difference, GetParam().Tolerance) << sheared;
    if (Rank() > 0)
    {
      EXPECT_EQ(History(filter)->GetNumberOfRows(), 0);
      continue;
    }
    std::cout << Count() << " processes: " << GetParam().Name << (sheared ? ", sheared" : "")
              << ": difference " << difference << ", iterations " << filter->GetNumberOfIterations()
              << ", alone " << alone->GetNumberOfIterations() << "\n";
    ASSERT_EQ(History(filter)->GetNumberOfRows(), History(alone)->GetNumberOfRows());
    for (const char* column : { "Energy", "Total_0", "Clamped" })
    {
      for (vtkIdType row = 0;
           History(alone)->GetColumnByName(column) && row < History(alone)->GetNumberOfRows();
           ++row)
      {
        const double expected = HistoryAt(alone, row, column);
        EXPECT_NEAR(HistoryAt(filter, row, column), expected,
          GetParam().Tolerance * std::max(1.0, std::abs(expected)))
          << column << " " << row;
      }
    }
  }
}

TEST_P(Together, SeekInTime)
{
  auto filter = GetParam().Make();
  filter->SetInputData(WithData(Mine(N)));
  filter->SetGenerateTimeSteps(true);
  const std::vector<double> times = PublishedTimes(filter);
  if (times.size() < 3)
  {
    GTEST_SKIP() << "has one step";
  }
  UpdateAt(filter, times[2]);
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 2);
  const auto second = Copy(Result(filter, GetParam().Result));
  UpdateAt(filter, times[1]);
  UpdateAt(filter, times[2]);
  EXPECT_TRUE(Identical(Result(filter, GetParam().Result), second));
  auto direct = GetParam().Make();
  direct->SetInputData(WithData(Mine(N)));
  direct->SetNumberOfTimeSteps(2);
  direct->Update();
  EXPECT_TRUE(Identical(Result(direct, GetParam().Result), second));
}

INSTANTIATE_TEST_SUITE_P(Pieces, Together,
  testing::Values(Case{ "heat", "fDiffused", Heat }, Case{ "turing", "u1", Turing },
    Case{ "turing, first order", "Texture", TuringFirstOrder },
    Case{ "turing until stationary", "u2", TuringUntilStationary, 1e-7 },
    Case{ "turing, multigrid", "u1", TuringMultigrid }, Case{ "harmonic", "vHarmonic", Harmonic },
    Case{ "harmonic, long steps", "vHarmonic", HarmonicLongSteps },
    Case{ "harmonic, multigrid", "vHarmonic", HarmonicMultigrid },
    Case{ "harmonic, inpainting", "vHarmonic", HarmonicInpainting },
    Case{ "harmonic, lines", "vHarmonic", HarmonicLines },
    Case{ "harmonic, paper", "vHarmonic", HarmonicPaper },
    Case{ "harmonic, minimizing movement", "vHarmonic", HarmonicMinimizingMovement },
    Case{ "edges", "Edges", Edges }, Case{ "edges, values", "vMumfordShah", Edges },
    Case{ "edges, inpainting", "roughMumfordShah", EdgesInpainting },
    Case{ "Beltrami", "vBeltrami", Beltrami },
    Case{ "Beltrami, inpainting", "roughBeltrami", BeltramiInpainting },
    Case{ "edge enhancing", "vEdgeEnhanced", EdgeEnhancing },
    Case{ "minimum", "fTV", Minimum, 1e-5 },
    Case{ "minimum, inpainting", "roughTV", MinimumInpainting },
    Case{ "minimum, L1", "vTV", MinimumL1 },
    Case{ "implicit steps", "roughTV", ImplicitSteps, 1e-6 }));

TEST_P(Together, StopWithinAStepIfOneOfThemIsAborted)
{
  auto filter = GetParam().Make();
  filter->SetInputData(WithData(Mine(N)));
  const unsigned long tag = Listen(filter,
    [&](double amount)
    {
      if (Rank() == Count() - 1 && amount > 0.26)
      {
        filter->SetAbortExecute(1);
      }
    });
  filter->Update();
  EXPECT_EQ(Result(filter, GetParam().Result), nullptr);
  EXPECT_LE(filter->GetNumberOfStepsComputed(), filter->GetNumberOfTimeSteps() / 2);
  filter->RemoveObserver(tag);
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  auto fresh = GetParam().Make();
  fresh->SetInputData(WithData(Mine(N)));
  fresh->Update();
  EXPECT_TRUE(Identical(Result(filter, GetParam().Result), Result(fresh, GetParam().Result)));
}

/// Columns begin .. end of a small grid of needle triangles, which was found by search, see below.
vtkSmartPointer<vtkPolyData> Needles(int begin, int end)
{
  constexpr int n = 4;
  std::mt19937 generator(328);
  double random[(n + 1) * (n + 1)][4];
  for (auto& ofPoint : random)
  {
    for (double& number : ofPoint)
    {
      number = generator() / 2147483648.0 - 1.0;
    }
  }
  auto needles = Strip(begin, end, n);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < needles->GetNumberOfPoints(); ++i)
  {
    double x[3];
    needles->GetPoint(i, x);
    const auto id = static_cast<int>(std::lround(x[0] * n) * (n + 1) + std::lround(x[1] * n));
    ids->InsertNextValue(id);
    needles->GetPoints()->SetPoint(
      i, x[0] + 0.11 * random[id][0], 0.1 * (x[1] + 0.11 * random[id][1]), 0.0);
  }
  needles->GetPointData()->SetGlobalIds(ids);
  AddPointArray(
    needles, "v", 2, [&](vtkIdType i, int k) { return random[ids->GetValue(i)][2 + k]; });
  return needles;
}

TEST(PiecesTogether, DampStepsThatWouldIncreaseTheEnergyAsTheWholeSurfaceDoes)
{
  const auto make = [](vtkPolyData* needles)
  {
    auto map = Make<vtkHarmonicMapFilter>("v", 8);
    map->SetExponent(2.0);
    map->SetTimeStep(1e4);
    map->SetInputData(needles);
    return map;
  };
  const auto together = make(Needles(4 * Rank() / Count(), 4 * (Rank() + 1) / Count()));
  together->Update();
  const auto alone = make(Needles(0, 4));
  alone->SetController(nullptr);
  alone->Update();
  EXPECT_LT(LargestDifference(together->GetOutput(), alone->GetOutput(), "vHarmonic"), 1e-9);
}

TEST(PiecesTogether, ConserveTheTotal)
{
  auto heat = MakeHeat();
  heat->SetSolverToMultigrid();
  heat->SetTimeStep(50.0);
  heat->Update();
  EXPECT_LT(heat->GetResidual(), 1e-10);
  if (Rank() == 0)
  {
    for (int row = 1; row < 11; ++row)
    {
      EXPECT_NEAR(HistoryAt(heat, row, "Total_0"), HistoryAt(heat, 0, "Total_0"), 1e-13);
    }
  }
}

TEST(PiecesTogether, StopWithinASolve)
{
  auto heat = MakeHeat();
  heat->SetSolverToConjugateGradient();
  heat->SetNumberOfTimeSteps(1);
  heat->SetTimeStep(1e4);
  int reports = 0;
  Listen(heat,
    [&](double amount)
    {
      reports += amount > 0.25 ? 1 : 0;
      if (Rank() == Count() - 1 && reports == 1)
      {
        heat->SetAbortExecute(1);
      }
    });
  heat->Update();
  EXPECT_EQ(Result(heat), nullptr);
  EXPECT_EQ(heat->GetNumberOfStepsComputed(), 0);
}

TEST(PiecesTogether, ReportAnErrorOfOneOfThemOnce)
{
  auto mine = Mine(N);
  if (Rank() == Count() - 1)
  {
    mine->GetPointData()->GetArray("f")->SetComponent(
      30, 0, std::numeric_limits<double>::infinity());
  }
  auto heat = MakeHeat();
  heat->SetInputData(mine);
  heat->SetSolverToConjugateGradient();
  Messages messages(heat);
  heat->Update();
  EXPECT_EQ(messages.Errors.size(), Rank() == 0 ? 1u : 0u);
  EXPECT_EQ(Result(heat), nullptr);
}

TEST(PiecesTogether, ReportInvalidRatesOfOneOfThemOnce)
{
  auto mine = WithData(Mine(N));
  mine->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "rates", mine->GetNumberOfCells(), 4,
    [&](vtkIdType i, int) { return Rank() == Count() - 1 && i == 5 ? -1.0 : 2.0; }));
  auto turing = Turing();
  turing->SetInputData(mine);
  SetInputArray(turing, 4, "rates", true);
  Messages messages(turing);
  turing->Update();
  EXPECT_EQ(messages.Errors.size(), Rank() == 0 ? 1u : 0u);
  EXPECT_EQ(Result(turing, "u1"), nullptr);
}

TEST(PiecesTogether, WarnOnceOfARemainingGap)
{
  auto tv = Make<vtkIntrinsicTVFilter>("rough", 1);
  tv->SetModeToSteadyState();
  tv->SetFidelityWeight(1e-3);
  tv->SetStopTolerance(1e-15);
  tv->SetInputData(WithData(Mine(N)));
  Messages messages(tv);
  tv->Update();
  EXPECT_EQ(messages.Warnings.size(), Rank() == 0 ? 1u : 0u);
}

TEST(PiecesTogether, PiecesWithoutTrianglesGiveFiniteResults)
{
  auto mine = WithData(Mine(N));
  if (Count() > 1 && Rank() == Count() - 1)
  {
    mine->SetPolys(nullptr);
  }
  auto heat = Heat();
  heat->SetInputData(mine);
  heat->Update();
  ASSERT_NE(Result(heat), nullptr);
  EXPECT_TRUE(AllFinite(Result(heat)));
}
