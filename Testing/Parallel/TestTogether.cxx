// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Solves by domain decomposition: each process with its own piece.
#include "Pieces.h"

#include "Distributed/Processes.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMumfordShahFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <mpi.h>

#include <functional>
#include <limits>
#include <map>
#include <random>
#include <type_traits>

using namespace Pieces;

namespace
{

long gatheredBytes = 0; // that this process received from all processes

} // namespace

/// Counts what MPI's own function receives.
extern "C" int MPI_Allgatherv(const void* sent, int count, MPI_Datatype type, void* received,
  const int* counts, const int* offsets, MPI_Datatype receivedType, MPI_Comm communicator)
{
  int width = 0;
  PMPI_Type_size(receivedType, &width);
  for (int p = 0; p < Count(); ++p)
  {
    gatheredBytes += static_cast<long>(width) * counts[p];
  }
  return PMPI_Allgatherv(sent, count, type, received, counts, offsets, receivedType, communicator);
}

namespace
{

constexpr int N = 24;

/// Gives the points of a piece of a square of n columns global ids that do not depend on the
/// decomposition, and calls move(id, coordinates) to change the coordinates.
template <typename Move>
vtkSmartPointer<vtkIdTypeArray> NumberAndMove(vtkPolyData* piece, int n, const Move& move)
{
  auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->SetName("ids");
  for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
  {
    double x[3];
    piece->GetPoint(i, x);
    const vtkIdType id = std::lround(x[0] * n) * (n + 1) + std::lround(x[1] * n);
    ids->InsertNextValue(id);
    move(id, x);
    piece->GetPoints()->SetPoint(i, x);
  }
  piece->GetPointData()->SetGlobalIds(ids);
  return ids;
}

/// A piece of a square of n columns with ids, vectors and a mask that do not depend on the
/// decomposition. sheared: with obtuse angles.
vtkSmartPointer<vtkPolyData> WithData(
  vtkSmartPointer<vtkPolyData> piece, bool sheared = false, int n = N)
{
  const auto ids =
    NumberAndMove(piece, n, [&](vtkIdType, double* x) { x[0] += sheared ? -0.8 * x[1] : 0.0; });
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
  std::function<AnyFilter()> Make;
  double Tolerance;
  int Columns = N; ///< of the square that they solve on
};

/// On a square that is too large for every process to solve a coarser level of it as a whole, and
/// for Automatic to gather it.
Case WithLevels(Case of)
{
  of.Columns = 104;
  return of;
}

template <typename Filter>
Case MakeCase(
  const char* name, const char* result, const char* array, int steps,
  void (*set)(Filter*) = [](Filter*) {}, double tolerance = 1e-9)
{
  return { name, result,
    [=]() -> AnyFilter
    {
      auto filter = Make<Filter>(array, steps);
      if constexpr (std::is_same_v<vtkIntrinsicTVFilter, Filter>)
      {
        filter->AutomaticFidelityOff(); // its search gathers the surface
      }
      set(filter);
      return filter;
    },
    tolerance };
}

std::ostream& operator<<(std::ostream& os, const Case& of)
{
  return os << of.Name;
}

/// The runs that the processes solve together. Minimisers differ by their duality gaps.
std::vector<Case> Cases()
{
  using Heat = vtkFVMHeatFilter;
  using Turing = vtkTuringTextureFilter;
  using Harmonic = vtkHarmonicMapFilter;
  using Shah = vtkMumfordShahFilter;
  using Tensor = vtkTensorDiffusionFilter;
  using TV = vtkIntrinsicTVFilter;
  return {
    MakeCase<Heat>("heat", "fDiffused", "f", 5),
    WithLevels(MakeCase<Heat>("heat, automatic", "fDiffused", "f", 5,
      [](Heat* f)
      {
        f->SetSolverToAutomatic();
        f->SetTimeStep(100.0);
      })),
    MakeCase<Heat>("heat, mixed mass matrix", "fDiffused", "f", 2,
      [](Heat* f)
      {
        f->SetMassMatrixToMixed();
        f->SetTimeIntegratorToExponential();
      }),
    MakeCase<Heat>("heat, mixed mass matrix, second order", "roughDiffused", "rough", 2,
      [](Heat* f)
      {
        f->SetMassMatrixToMixed();
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
      }),
    MakeCase<Turing>("turing", "u1", "", 20),
    MakeCase<Turing>("turing, first order", "Texture", "", 20,
      [](Turing* f)
      {
        f->SetTimeIntegratorToFirstOrder();
        f->SetInitialNoise(0.9);
      }),
    MakeCase<Turing>(
      "turing until stationary", "u2", "", 300, [](Turing* f) { f->SetStopTolerance(0.3); }, 1e-7),
    WithLevels(MakeCase<Turing>(
      "turing, multigrid", "u1", "", 5, [](Turing* f) { f->SetSolverToMultigrid(); })),
    MakeCase<Harmonic>("harmonic", "vHarmonic", "v", 5),
    MakeCase<Harmonic>("harmonic, long steps", "vHarmonic", "v", 3,
      [](Harmonic* f)
      {
        f->SetTimeStep(100.0);
        f->SetExponent(2.0);
      }),
    WithLevels(MakeCase<Harmonic>("harmonic, multigrid", "vHarmonic", "v", 3,
      [](Harmonic* f)
      {
        f->SetSolverToMultigrid();
        f->SetTimeStep(20.0);
      })),
    MakeCase<Harmonic>("harmonic, inpainting", "vHarmonic", "v", 5,
      [](Harmonic* f)
      {
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
        f->SetFidelityWeight(0.2);
      }),
    MakeCase<Harmonic>(
      "harmonic, lines", "vHarmonic", "v", 5, [](Harmonic* f) { f->SetLineField(true); }),
    MakeCase<Harmonic>("harmonic, paper", "vHarmonic", "v", 5,
      [](Harmonic* f)
      {
        f->UsePaperScheme();
        SetInputArray(f, 3, "edge");
      }),
    MakeCase<Harmonic>("harmonic, minimizing movement", "vHarmonic", "v", 2,
      [](Harmonic* f) { f->SetSchemeToMinimizingMovement(); }),
    MakeCase<Shah>("edges", "Edges", "v", 12,
      [](Shah* f)
      {
        f->EdgeCurvesOff();
        f->AutomaticThresholdOff();
        f->SetEdgeThreshold(0.8);
      }),
    MakeCase<Shah>("edges, values", "vMumfordShah", "v", 12,
      [](Shah* f)
      {
        f->EdgeCurvesOff();
        f->AutomaticThresholdOff();
        f->SetEdgeThreshold(0.8);
      }),
    MakeCase<Shah>("edges, inpainting", "roughMumfordShah", "rough", 12,
      [](Shah* f)
      {
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
        f->EdgeCurvesOff();
        f->AutomaticThresholdOff();
      }),
    MakeCase<Tensor>("Beltrami", "vBeltrami", "v", 5),
    MakeCase<Tensor>("Beltrami, inpainting", "roughBeltrami", "rough", 5,
      [](Tensor* f)
      {
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
        f->SetFidelityWeight(0.2);
        f->SetMetricToFixed();
      }),
    MakeCase<Tensor>(
      "edge enhancing", "vEdgeEnhanced", "v", 5, [](Tensor* f) { f->SetModelToEdgeEnhancing(); }),
    MakeCase<TV>(
      "minimum", "fTV", "f", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->SetFidelityWeight(0.3);
        f->SetStopTolerance(1e-7);
      },
      1e-5),
    MakeCase<TV>(
      "minimum, inpainting", "roughTV", "rough", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->SetEdgeFunctionToCharbonnier();
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
        f->SetHoldKnownValues(true);
        f->SetStopTolerance(1e-6); // in double precision
      },
      1e-7),
    MakeCase<TV>("minimum, L1", "vTV", "v", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->SetStopTolerance(1e-5); // in double precision
        f->SetFidelityNormToL1();
        f->SetFidelityWeight(2.0);
      }),
    MakeCase<TV>("opponent colours", "vTV", "v", 4,
      [](TV* f)
      {
        f->SetColorModelToOpponent();
        SetInputArray(f, 1, "hole");
      }),
    MakeCase<TV>(
      "opponent colours, minimum", "vTV", "v", 1,
      [](TV* f)
      {
        f->SetColorModelToOpponent();
        f->SetModeToSteadyState();
        f->SetStopTolerance(1e-6);
      },
      1e-4),
    MakeCase<TV>("chromaticity", "vTV", "v", 4,
      [](TV* f)
      {
        f->SetColorModelToChromaticityBrightness();
        SetInputArray(f, 1, "hole");
        SetInputArray(f, 3, "edge");
      }),
    MakeCase<TV>(
      "implicit steps", "roughTV", "rough", 4,
      [](TV* f)
      {
        f->SetTimeIntegratorToImplicit();
        f->SetStopTolerance(1e-7); // the penalty may grow at another iteration
      },
      1e-6),
  };
}

/// The largest difference from the result of a single process, at points of equal ids, over all
/// processes.
double LargestDifference(vtkPolyData* mine, vtkPolyData* whole, const char* name)
{
  vtkDataArray* const here = mine->GetPointData()->GetArray(name);
  vtkDataArray* const there = whole->GetPointData()->GetArray(name);
  if (!here || !there)
  {
    return OfAll(VTK_DOUBLE_MAX, vtkCommunicator::MAX_OP);
  }
  double largest = 0.0;
  std::map<double, vtkIdType> pointOf;
  for (vtkIdType i = 0; i < whole->GetNumberOfPoints(); ++i)
  {
    pointOf[whole->GetPointData()->GetGlobalIds()->GetComponent(i, 0)] = i;
  }
  for (vtkIdType i = 0; i < mine->GetNumberOfPoints(); ++i)
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

vtkSmartPointer<vtkPolyData> MyPiece(const Case& of, bool sheared = false)
{
  return WithData(Mine(of.Columns), sheared, of.Columns);
}

TEST_P(Together, GiveTheResultOfTheWholeSurface)
{
  for (const bool sheared : { false, true })
  {
    auto filter = GetParam().Make();
    filter->SetInputData(MyPiece(GetParam(), sheared));
    bool workedHere = false; // if surfaces are gathered, only process 0 computes
    Listen(
      filter, [&](double amount) { workedHere = workedHere || (amount > 0.0 && amount < 1.0); });
    filter->Update();
    EXPECT_TRUE(workedHere);

    auto alone = GetParam().Make();
    alone->SetController(nullptr);
    const int n = GetParam().Columns;
    alone->SetInputData(WithData(Strip(0, n, n), sheared, n));
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
  filter->SetInputData(MyPiece(GetParam()));
  filter->SetGenerateTimeSteps(true);
  const std::vector<double> times = PublishedTimes(filter);
  if (times.size() < 3)
  {
    GTEST_SKIP() << "has one step";
  }
  UpdateAt(filter, times[2]);
  // A run that may end early is computed to its end, and publishes the steps that it has.
  const auto last = static_cast<vtkIdType>(PublishedTimes(filter).size()) - 1;
  const vtkIdType computed = filter->GetNumberOfStepsComputed();
  EXPECT_TRUE(computed == 2 || computed == last) << computed;
  const auto second = Copy(Result(filter, GetParam().Result));
  UpdateAt(filter, times[1]);
  UpdateAt(filter, times[2]);
  EXPECT_TRUE(Identical(Result(filter, GetParam().Result), second));
  auto direct = GetParam().Make();
  direct->SetInputData(MyPiece(GetParam()));
  direct->SetNumberOfTimeSteps(2);
  direct->Update();
  EXPECT_TRUE(Identical(Result(direct, GetParam().Result), second));
}

/// The triangles of the square that `owner` gives to this process: a function of their number and
/// of a corner.
template <typename Owner>
vtkSmartPointer<vtkPolyData> MinePicked(int n, const Owner& owner)
{
  const auto whole = WithData(Strip(0, n, n), false, n);
  auto mine = vtkSmartPointer<vtkPolyData>::New();
  mine->SetPoints(whole->GetPoints());
  mine->GetPointData()->ShallowCopy(whole->GetPointData());
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType t = 0; t < whole->GetNumberOfCells(); ++t)
  {
    vtkNew<vtkIdList> corners;
    whole->GetCellPoints(t, corners);
    if (owner(t, whole->GetPoint(corners->GetId(0))) == Rank())
    {
      triangles->InsertNextCell(corners);
    }
  }
  mine->SetPolys(triangles);
  return mine;
}

/// Long steps with multigrid.
vtkSmartPointer<vtkFVMHeatFilter> RunLongSteps(
  vtkPolyData* input, vtkMultiProcessController* controller)
{
  auto heat = Make<vtkFVMHeatFilter>("rough", 2);
  heat->SetController(controller);
  heat->SetSolverToMultigrid();
  heat->SetTimeStep(1e4);
  heat->SetInputData(input);
  heat->Update();
  return heat;
}

/// Pieces are strips, tiles that meet in corners, and triangles at random. The latter put nearly
/// all vertices on interfaces, where the prolongation is not smoothed.
TEST(MultigridOverProcesses, TakesHardlyMoreIterationsThanOneProcess)
{
  constexpr int n = 224; // two levels with interfaces, and one that every process solves
  const auto alone = RunLongSteps(WithData(Strip(0, n, n), false, n), nullptr);
  std::mt19937 random(7);
  const auto inTiles = [](vtkIdType, const double* x)
  { return (static_cast<int>(5.0 * x[0]) + 2 * static_cast<int>(5.0 * x[1])) % Count(); };
  const auto atRandom = [&](vtkIdType, const double*)
  { return static_cast<int>(random() % static_cast<unsigned>(Count())); };
  struct Pieces
  {
    const char* Name;
    vtkSmartPointer<vtkPolyData> Mine;
    double Factor; ///< the most iterations over those of one process
  };
  const std::vector<Pieces> all = {
    { "strips", WithData(Mine(n), false, n), 1.15 },
    { "tiles", MinePicked(n, inTiles), 1.15 },
    { "at random", MinePicked(n, atRandom), 4.0 },
  };
  for (const auto& [name, piece, factor] : all)
  {
    const auto heat = RunLongSteps(piece, vtkMultiProcessController::GetGlobalController());
    const double difference =
      LargestDifference(heat->GetOutput(), alone->GetOutput(), "roughDiffused");
    EXPECT_LT(difference, 1e-10) << name;
    if (Rank() == 0)
    {
      std::cout << Count() << " processes, " << name << ": difference " << difference
                << ", iterations " << heat->GetNumberOfIterations() << ", alone "
                << alone->GetNumberOfIterations() << "\n";
      EXPECT_LE(heat->GetNumberOfIterations(), factor * alone->GetNumberOfIterations()) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Pieces, Together, testing::ValuesIn(Cases()));

TEST_P(Together, StopWithinAStepIfOneOfThemIsAborted)
{
  auto filter = GetParam().Make();
  filter->SetInputData(MyPiece(GetParam()));
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
  fresh->SetInputData(MyPiece(GetParam()));
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
  const auto ids = NumberAndMove(needles, n,
    [&](vtkIdType id, double* x)
    {
      x[0] += 0.11 * random[id][0];
      x[1] = 0.1 * (x[1] + 0.11 * random[id][1]);
      x[2] = 0.0;
    });
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

/// Meridians begin .. end of the n of a part of a sphere, with needles at its poles.
vtkSmartPointer<vtkPolyData> Wedge(int begin, int end, int n)
{
  auto wedge = Strip(begin, end, n);
  NumberAndMove(wedge, n,
    [n](vtkIdType, double* x)
    {
      const double longitude = 6.0 * x[0];
      const double fromPole = std::acos(-1.0) * (x[1] * n + 0.5) / (n + 1);
      x[0] = std::cos(longitude) * std::sin(fromPole);
      x[1] = std::sin(longitude) * std::sin(fromPole);
      x[2] = std::cos(fromPole);
    });
  return wedge;
}

TEST(AutomaticOverProcesses, ResolvesNeedles)
{
  constexpr int n = 120;
  const auto make = [](int begin, int end)
  {
    auto heat = Make<vtkFVMHeatFilter>("f", 2);
    heat->SetInputData(Wedge(begin, end, n));
    heat->SetTimeStep(300.0);
    return heat;
  };
  const auto together = make(n * Rank() / Count(), n * (Rank() + 1) / Count());
  together->SetMaximumNumberOfIterations(100);
  int errors = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&errors);
  count->SetCallback(
    [](vtkObject*, unsigned long, void* counted, void*) { ++*static_cast<int*>(counted); });
  together->AddObserver(vtkCommand::ErrorEvent, count);
  together->Update();
  EXPECT_EQ(errors, Rank() == 0 ? 1 : 0);
  EXPECT_EQ(Result(together, "fDiffused"), nullptr); // with conjugate gradients
  together->SetSolverToAutomatic();
  together->Update();
  const auto alone = make(0, n);
  alone->SetController(nullptr);
  alone->SetSolverToDirect();
  alone->Update();
  EXPECT_LT(LargestDifference(together->GetOutput(), alone->GetOutput(), "fDiffused"), 1e-9);
  EXPECT_EQ(errors, Rank() == 0 ? 1 : 0);
  if (Rank() == 0)
  {
    std::cout << Count() << " processes, needles: iterations " << together->GetNumberOfIterations()
              << "\n";
  }
}

/// MPI holds large messages back until their receivers are ready.
TEST(Processes, ExchangeLargeMessagesWithAllOthers)
{
  const SurfaceDiffusion::Processes processes(vtkMultiProcessController::GetGlobalController());
  constexpr int length = 300000;
  std::vector<int> others;
  std::map<int, std::vector<double>> sent;
  for (int other = 0; other < Count(); ++other)
  {
    if (other != Rank())
    {
      others.push_back(other);
      sent[other].assign(length, 100.0 * Rank() + other);
    }
  }
  const std::map<int, std::vector<double>> received = processes.Exchange(others, sent);
  for (const int other : others)
  {
    EXPECT_EQ(received.at(other), std::vector<double>(length, 100.0 * other + Rank()));
  }
}

TEST(PiecesTogether, ConserveTheTotal)
{
  auto heat = MakeHeat();
  heat->SetSolverToMultigrid();
  heat->SetTimeStep(50.0);
  heat->SetTolerance(1e-10);
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
  auto turing = Make<vtkTuringTextureFilter>("", 20);
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
  auto heat = Make<vtkFVMHeatFilter>("f", 5);
  heat->SetInputData(mine);
  heat->Update();
  ASSERT_NE(Result(heat), nullptr);
  EXPECT_TRUE(AllFinite(Result(heat)));
}

namespace
{

/// A piece with cell data that do not depend on the decomposition; ghosts: with a column of cells
/// of the piece before it, marked as copies.
vtkSmartPointer<vtkPolyData> WithCells(int begin, int end, bool quads, bool ghosts)
{
  const int first = begin - (ghosts && begin > 0 ? 1 : 0);
  auto piece = WithData(Strip(first, end, N));
  if (quads)
  {
    vtkNew<vtkCellArray> cells;
    const vtkIdType nx = end - first + 1;
    for (vtkIdType j = 0; j < N; ++j)
    {
      for (vtkIdType i = 0; i + 1 < nx; ++i)
      {
        const vtkIdType a = i + nx * j;
        cells->InsertNextCell({ a, a + 1, a + nx + 1, a + nx });
      }
    }
    piece->SetPolys(cells);
  }
  for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i) // no regular grid
  {
    double x[3];
    piece->GetPoint(i, x);
    const double id = piece->GetPointData()->GetGlobalIds()->GetComponent(i, 0);
    piece->GetPoints()->SetPoint(i, x[0] + 0.2 / N * Rough(static_cast<vtkIdType>(id), 0),
      x[1] + 0.2 / N * Rough(static_cast<vtkIdType>(id), 1), 0.1 * std::sin(5.0 * x[0]));
  }
  vtkNew<vtkIdList> corners;
  const auto add = [&](const char* name, const auto& value)
  {
    piece->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, name, piece->GetNumberOfCells(), 1,
      [&](vtkIdType c, int)
      {
        piece->GetCellPoints(c, corners);
        double x[3];
        piece->GetPoint(corners->GetId(0), x);
        const auto id = static_cast<vtkIdType>(
          piece->GetPointData()->GetGlobalIds()->GetComponent(corners->GetId(0), 0));
        return value(x, id);
      }));
  };
  add("c", [](const double* x, vtkIdType id) { return Data(x) + 0.3 * Rough(id, 0); });
  add("hole of cells",
    [](const double* x, vtkIdType) { return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.2; });
  add("ends of cells", [](const double* x, vtkIdType) { return x[1] < 1.5 / N; });
  add("weights of cells", [](const double*, vtkIdType id) { return 1.5 + Rough(id, 1); });
  if (ghosts)
  {
    piece->GetCellData()->AddArray(MakeArray(VTK_UNSIGNED_CHAR,
      vtkDataSetAttributes::GhostArrayName(), piece->GetNumberOfCells(), 1,
      [&](vtkIdType c, int)
      {
        const vtkIdType perRow = (quads ? 1 : 2) * static_cast<vtkIdType>(end - first);
        const bool isCopy = first < begin && c % perRow < (quads ? 1 : 2);
        return isCopy ? static_cast<int>(vtkDataSetAttributes::DUPLICATECELL) : 0;
      }));
  }
  return piece;
}

/// The largest difference of a cell array from that of a single process, at cells of equal points,
/// over all processes. Copies are left out.
double LargestDifferenceOfCells(vtkPolyData* mine, vtkPolyData* whole, const char* name)
{
  const auto keyOf = [](vtkPolyData* surface, vtkIdType cell)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(cell, corners);
    std::vector<double> key;
    for (const vtkIdType i : *corners)
    {
      key.push_back(surface->GetPointData()->GetGlobalIds()->GetComponent(i, 0));
    }
    std::sort(key.begin(), key.end());
    return key;
  };
  vtkDataArray* const here = mine->GetCellData()->GetArray(name);
  vtkDataArray* const there = whole->GetCellData()->GetArray(name);
  vtkUnsignedCharArray* const ghosts = mine->GetCellGhostArray();
  std::map<std::vector<double>, vtkIdType> cellOf;
  for (vtkIdType c = 0; c < whole->GetNumberOfCells(); ++c)
  {
    cellOf[keyOf(whole, c)] = c;
  }
  double largest = here && there ? 0.0 : VTK_DOUBLE_MAX;
  for (vtkIdType c = 0; here && there && c < mine->GetNumberOfCells(); ++c)
  {
    if (!ghosts || ghosts->GetValue(c) == 0)
    {
      const double value = there->GetComponent(cellOf.at(keyOf(mine, c)), 0);
      largest = std::max(largest, std::abs(here->GetComponent(c, 0) - value));
    }
  }
  return OfAll(largest, vtkCommunicator::MAX_OP);
}

} // namespace

TEST(PiecesTogether, TakeCellData)
{
  struct Variant
  {
    const char* Name;
    void (*Set)(vtkFVMHeatFilter*);
  };
  const Variant variants[] = { { "smoothing", [](vtkFVMHeatFilter*) {} },
    { "mean", [](vtkFVMHeatFilter* heat) { heat->KeepCellDetailOff(); } },
    { "inpainting",
      [](vtkFVMHeatFilter* heat)
      {
        SetInputArray(heat, 1, "hole of cells", true);
        heat->SetFidelityWeight(0.1);
      } },
    { "exclusion",
      [](vtkFVMHeatFilter* heat)
      {
        SetInputArray(heat, 1, "hole of cells", true);
        heat->SetMaskModeToExclude();
      } },
    { "fixed", [](vtkFVMHeatFilter* heat) { SetInputArray(heat, 3, "ends of cells", true); } },
    { "marks of points",
      [](vtkFVMHeatFilter* heat)
      {
        SetInputArray(heat, 1, "hole");
        SetInputArray(heat, 3, "edge");
      } },
    { "fidelity",
      [](vtkFVMHeatFilter* heat)
      {
        heat->SetFidelityWeight(0.2);
        SetInputArray(heat, 5, "weights of cells", true);
      } } };
  for (const Variant& variant : variants)
  {
    for (const bool quads : { false, true })
    {
      for (const bool ghosts : { false, true })
      {
        const auto make = [&](vtkPolyData* surface)
        {
          auto heat = Make<vtkFVMHeatFilter>("c", 1);
          SetInputArray(heat, 0, "c", true);
          heat->SetTolerance(1e-14);
          heat->SetTimeIntegratorToFirstOrder();
          heat->SetTimeStep(0.2);
          variant.Set(heat);
          heat->SetInputData(surface);
          return heat;
        };
        const auto mine =
          WithCells(N * Rank() / Count(), N * (Rank() + 1) / Count(), quads, ghosts);
        const auto together = make(mine);
        bool workedHere = false;
        Listen(together,
          [&](double amount) { workedHere = workedHere || (amount > 0.0 && amount < 1.0); });
        together->Update();
        EXPECT_TRUE(workedHere);
        const auto alone = make(WithCells(0, N, quads, false));
        alone->SetController(nullptr);
        alone->Update();
        EXPECT_LT(
          LargestDifferenceOfCells(together->GetOutput(), alone->GetOutput(), "cDiffused"), 1e-12)
          << variant.Name << quads << ghosts;
      }
    }
  }
}

/// Points of masked, fixed and weighted cells.
TEST(PiecesTogether, TakeMarksOfCellsForPointData)
{
  for (const int index : { 1, 3, 5 })
  {
    const auto make = [&](vtkPolyData* surface)
    {
      auto heat = Make<vtkFVMHeatFilter>("rough", 1);
      heat->SetFidelityWeight(0.2);
      heat->SetTolerance(1e-14);
      heat->SetTimeIntegratorToFirstOrder();
      heat->SetTimeStep(0.2);
      SetInputArray(heat, index,
        index == 1 ? "hole of cells" : (index == 3 ? "ends of cells" : "weights of cells"), true);
      heat->SetInputData(surface);
      return heat;
    };
    const auto together =
      make(WithCells(N * Rank() / Count(), N * (Rank() + 1) / Count(), false, false));
    together->Update();
    const auto alone = make(WithCells(0, N, false, false));
    alone->SetController(nullptr);
    alone->Update();
    EXPECT_LT(LargestDifference(together->GetOutput(), alone->GetOutput(), "roughDiffused"), 1e-12)
      << index;
  }
}

/// Points on interfaces are sent to neighbours: nothing that all processes receive grows with them.
TEST(PiecesTogether, SendTheirPointsToNeighboursOnly)
{
  std::vector<long> bytes;
  for (const int n : { N, 4 * N })
  {
    for (const bool byId : { false, true })
    {
      const auto mine = WithData(Mine(n));
      if (!byId)
      {
        mine->GetPointData()->SetGlobalIds(nullptr);
      }
      auto heat = Make<vtkFVMHeatFilter>("f", 1);
      heat->SetInputData(mine);
      gatheredBytes = 0;
      heat->Update();
      EXPECT_NE(Result(heat, "fDiffused"), nullptr);
      bytes.push_back(gatheredBytes);
    }
  }
  EXPECT_EQ(bytes[0] > 0, Count() > 1);
  EXPECT_EQ(bytes[2], bytes[0]);
  EXPECT_EQ(bytes[3], bytes[1]);
}

/// Surfaces that are gathered in process 0.
TEST(PiecesTogether, HaveLabelsOfTheirCells)
{
  const auto make = [&](vtkPolyData* surface)
  {
    auto segmentation = vtkSmartPointer<vtkSurfaceSegmentationFilter>::New();
    SetInputArray(segmentation, 0, "c", true);
    segmentation->SetInputData(surface);
    return segmentation;
  };
  const auto together =
    make(WithCells(N * Rank() / Count(), N * (Rank() + 1) / Count(), true, true));
  together->Update();
  const auto alone = make(WithCells(0, N, true, false));
  alone->SetController(nullptr);
  alone->Update();
  EXPECT_LT(
    LargestDifferenceOfCells(together->GetOutput(), alone->GetOutput(), "RegionProbability"), 1e-6);
  for (vtkPolyData* const surface : { together->GetOutput(), alone->GetOutput() })
  {
    vtkDataArray* const labels = surface->GetCellData()->GetArray("RegionId");
    vtkDataArray* const probabilities = surface->GetCellData()->GetArray("RegionProbability");
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
    {
      if (probabilities->GetComponent(c, 0) < 0.501) // round-off decides between two regions
      {
        labels->SetComponent(c, 0, 0.0);
      }
    }
  }
  EXPECT_EQ(LargestDifferenceOfCells(together->GetOutput(), alone->GetOutput(), "RegionId"), 0.0);
}

/// Sources and points that paths lead from, of which each process has some.
TEST(PiecesTogether, HavePathsToTheSourcesOfAllProcesses)
{
  const auto pointsOf = [](int seed, int process, int count)
  {
    constexpr int number = 12;
    auto points = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    for (int i = number * process / count; i < number * (process + 1) / count; ++i)
    {
      places->InsertNextPoint(
        0.5 + 0.5 * Rough(i, seed), 0.5 + 0.5 * Rough(i, seed + 1), 0.05 * Rough(i, seed + 2));
    }
    points->SetPoints(places);
    return points;
  };
  const auto make = [&](vtkPolyData* surface, int process, int count)
  {
    auto distance = vtkSmartPointer<vtkSurfaceDistanceFilter>::New();
    distance->SetInputData(surface);
    distance->SetInputData(1, pointsOf(0, process, count));
    distance->SetInputData(2, pointsOf(3, process, count));
    return distance;
  };
  const auto together =
    make(WithCells(N * Rank() / Count(), N * (Rank() + 1) / Count(), true, true), Rank(), Count());
  const auto alone = make(WithCells(0, N, true, false), 0, 1);
  alone->SetController(nullptr);
  together->Update();
  alone->Update();
  EXPECT_LT(LargestDifference(together->GetOutput(), alone->GetOutput(), "Distance"), 1e-12);
  auto* const found = vtkPolyData::SafeDownCast(together->GetOutputDataObject(1));
  auto* const expected = vtkPolyData::SafeDownCast(alone->GetOutputDataObject(1));
  EXPECT_EQ(expected->GetNumberOfCells(), 12);
  ASSERT_EQ(found->GetNumberOfCells(), Rank() == 0 ? 12 : 0);
  for (vtkIdType c = 0; c < found->GetNumberOfCells(); ++c)
  {
    EXPECT_NEAR(found->GetCellData()->GetArray("Length")->GetComponent(c, 0),
      expected->GetCellData()->GetArray("Length")->GetComponent(c, 0), 1e-12);
  }
}

/// Values of the surface's points and cells, and points with values of which each process has some.
TEST(PiecesTogether, InterpolateTheValuesOfAllProcesses)
{
  constexpr int probes = 40;
  const auto pointsOf = [](int process, int count)
  {
    auto points = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    for (int i = probes * process / count; i < probes * (process + 1) / count; ++i)
    {
      places->InsertNextPoint(0.5 + 0.5 * Rough(i, 0), 0.5 + 0.5 * Rough(i, 1), 0.05 * Rough(i, 2));
    }
    points->SetPoints(places);
    AddPointArray(points, "t", 1, [&](vtkIdType i, int) { return Data(places->GetPoint(i)); });
    points->GetPointData()->SetActiveScalars("t");
    return points;
  };
  const auto make = [&](vtkPolyData* surface, const char* array, bool onCells)
  {
    auto spline = vtkSmartPointer<vtkSurfaceInterpolationFilter>::New();
    SetInputArray(spline, 0, array, onCells);
    spline->ComputeErrorOn();
    spline->SetInputData(surface);
    return spline;
  };
  for (const char* const kind : { "points", "cells", "beside" })
  {
    const bool onCells = kind == std::string("cells");
    const bool isBeside = kind == std::string("beside");
    const char* const array = onCells ? "c" : "rough";
    const auto together =
      make(WithCells(N * Rank() / Count(), N * (Rank() + 1) / Count(), true, true), array, onCells);
    const auto alone = make(WithCells(0, N, true, false), array, onCells);
    alone->SetController(nullptr);
    if (isBeside)
    {
      together->SetInputData(1, pointsOf(Rank(), Count()));
      alone->SetInputData(1, pointsOf(0, 1));
    }
    together->Update();
    alone->Update();
    const std::string name = isBeside ? "t" : array;
    for (const char* const result : { "Interpolated", "Error" })
    {
      const std::string of = name + result;
      const double difference = onCells
        ? LargestDifferenceOfCells(together->GetOutput(), alone->GetOutput(), of.c_str())
        : LargestDifference(together->GetOutput(), alone->GetOutput(), of.c_str());
      // Variances are differences of inverses, of which round-off takes nine digits.
      EXPECT_LT(difference, result == std::string("Error") ? 2e-8 : 1e-9) << kind << " " << of;
    }
    EXPECT_GT(alone->GetNumberOfValues(), isBeside ? probes - 1 : N * N / 2) << kind;
  }
}
