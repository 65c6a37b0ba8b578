// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every model promises, for every model of ModelKinds.h. SURFACEDIFFUSION_LONG in the
// environment selects every place where a run can end early.
#include "Allocations.h"
#include "CellRun.h"
#include "Meshes.h"
#include "ModelKinds.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Serial loops, one of which is aborted in its middle.
class AbortedFor : public ParallelFor
{
public:
  void Run(Index count, LoopBody body) const override
  {
    if (--this->Left == 0)
    {
      body(0, count / 2);
      throw Aborted();
    }
    body(0, count);
  }
  void RunTasks(Index count, LoopBody body) const override { this->Run(count, body); }

  mutable long Left = 0; ///< the number of the loop that is aborted, or 0
};

class ModelContract : public testing::TestWithParam<ModelKind>
{
protected:
  const ModelKind& Kind = this->GetParam();
  std::shared_ptr<RunSettings> Settings = this->Kind.Make(nullptr);

  /// Minimisers iterate in single precision for tolerances that allow it.
  bool UsesSinglePrecision() const
  {
    const auto* const variation = dynamic_cast<const TotalVariationSettings*>(this->Settings.get());
    return this->IsSegmentation() || (variation && variation->Minimizes());
  }
  /// What numbering may change, relative to the largest value: round-off, and what iterations that
  /// end elsewhere leave.
  double NumberingTolerance() const
  {
    if (this->UsesSinglePrecision())
    {
      return 1e-7;
    }
    const auto* const variation = dynamic_cast<const TotalVariationSettings*>(this->Settings.get());
    if (variation && variation->Discretization == Discretization::CrouzeixRaviart)
    {
      return 1e-9;
    }
    const auto* const stepping = dynamic_cast<const TimeSettings*>(this->Settings.get());
    return stepping && stepping->Solver == SolverMethod::Multigrid ? 1e-11 : 1e-12;
  }
  /// Models that mix components round relative to the largest.
  bool MixesComponents() const
  {
    const auto* const variation = dynamic_cast<const TotalVariationSettings*>(this->Settings.get());
    return variation && !variation->Color.IsRGB();
  }
  bool UsesRandomNumbers() const { return this->Settings->DescribeModel().UsesRandomNumbers; }
  bool IsSegmentation() const
  {
    return dynamic_cast<const SegmentationSettings*>(this->Settings.get()) != nullptr;
  }
  /// Change a setting of models with time steps.
  template <typename Change>
  void Set(const Change& change)
  {
    if (auto* const settings = dynamic_cast<TimeSettings*>(this->Settings.get()))
    {
      change(*settings);
    }
  }
  int LastStep() const { return this->Settings->DescribeModel().NumberOfSteps; }

  /// A noisy step around 100, or of the direction of unit vectors, with a hole. components: of
  /// scalars
  CellInput MakeInput(const Testing::Surface& surface, int components = 1) const
  {
    CellInput input(surface);
    input.Data.Data.OnCells = this->Kind.IsOnCells();
    if (!this->Kind.IsOnCells())
    {
      input.Data.Cells.clear();
    }
    if (this->Settings->DescribeModel().NeedsDirections)
    {
      input.Data.Directions.Values =
        Eigen::RowVector3d(1.0, 2.0, 3.0).replicate(input.Vertices.rows(), 1);
    }
    if (this->Kind.Data == Content::Nothing)
    {
      input.Data.Data.Values.resize(0, 0);
      return input;
    }
    const Points places = this->Kind.IsOnCells() ? input.Centres() : input.Vertices;
    Values& f = input.Data.Data.Values;
    f.resize(places.rows(), components * this->Kind.NumberOfComponents());
    for (Eigen::Index i = 0; i < f.rows(); ++i)
    {
      for (Eigen::Index k = 0; k < f.cols(); ++k)
      {
        f(i, k) = (this->Kind.HasUnitVectors() ? (k == 2 ? 3.0 : 0.0) : 100.0) +
          (places(i, 0) > 0.1 ? 1.0 : 0.0) + UniformRandom(3, k, i);
      }
    }
    f.middleRows(f.rows() / 2, 30).setConstant(std::numeric_limits<double>::quiet_NaN());
    return input;
  }

  void Update(SurfaceDiffusion::Run& run, const RunInput& input,
    const ProgressMonitor& progress = ProgressMonitor()) const
  {
    run.Update({ input.Block() }, this->Settings, Alone, progress);
  }

  /// The state of a run at the points or cells of its data.
  Values RowsOfData(const SurfaceDiffusion::Run& run, const RunInput& input) const
  {
    const SurfaceDiffusion::Run::Block& block = run.GetBlock(0);
    if (this->Kind.IsOnCells())
    {
      const Values rows = block.CellResult(input.Data.Data.Values, true, SerialFor());
      return rows.array().isNaN().select(-1.0, rows); // NaN != NaN
    }
    Values rows(input.Data.Data.Values.rows(), input.Data.Data.Values.cols());
    for (Index i = 0; i < static_cast<Index>(rows.rows()); ++i)
    {
      rows.row(i) = block.Path->State().row(block.Surface->VertexOf(i));
    }
    return rows;
  }

  /// All that a run returns at a step.
  std::vector<Values> ResultsAt(SurfaceDiffusion::Run& run, const RunInput& input, int step,
    const ProgressMonitor& progress = ProgressMonitor()) const
  {
    run.Seek(step, progress);
    const SurfaceDiffusion::Run::Block& block = run.GetBlock(0);
    const auto record = static_cast<std::size_t>(block.Path->Step());
    std::vector<Values> results{ block.Path->State(),
      Values::Constant(1, 1, block.Path->Records()[record].Energy) };
    if (this->Kind.IsOnCells() && !this->IsSegmentation())
    {
      results.push_back(this->RowsOfData(run, input));
    }
    for (const Output& output : block.Outputs)
    {
      results.push_back(output.Rows);
      if (output.Lines)
      {
        results.push_back(output.Lines->Points);
      }
    }
    return results;
  }

  std::vector<Values> Compute(SurfaceDiffusion::Run& run, const RunInput& input,
    const ProgressMonitor& progress = ProgressMonitor()) const
  {
    this->Update(run, input, progress.Part(0.0, 0.5));
    return this->ResultsAt(run, input, this->LastStep(), progress.Part(0.5, 1.0));
  }

  Values StateOn(const RunInput& input) const
  {
    SurfaceDiffusion::Run run(SerialFor());
    return this->Compute(run, input).front();
  }

  /// To the last bit; NaN is NaN.
  static bool AreSame(const std::vector<Values>& a, const std::vector<Values>& b)
  {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
      [](const Values& x, const Values& y)
      {
        return x.rows() == y.rows() && x.cols() == y.cols() &&
          (x.array() == y.array() || (x.array() != x.array() && y.array() != y.array())).all();
      });
  }

  /// For some of the places 1 .. all where a run may end early: compute with an end at this place,
  /// which `endAt` sets, and then again without it. Returns the share of the runs that ended.
  template <typename EndAt>
  double ExpectRunsToContinue(long all, const ParallelFor& loops, const CellInput& input,
    const ProgressMonitor& progress, const std::vector<Values>& expected, const EndAt& endAt) const
  {
    const bool isLong = std::getenv("SURFACEDIFFUSION_LONG") != nullptr;
    int runs = 0, ends = 0;
    for (long place = 1; place <= all; place += isLong ? 1 + place / 100 : 1 + all / 12, ++runs)
    {
      SurfaceDiffusion::Run run(loops);
      endAt(place);
      try
      {
        this->Compute(run, input, progress);
      }
      catch (const Aborted&)
      {
        ++ends;
      }
      catch (const std::bad_alloc&)
      {
        ++ends;
      }
      endAt(0);
      EXPECT_TRUE(AreSame(this->Compute(run, input), expected))
        << "place " << place << " of " << all;
    }
    return static_cast<double>(ends) / runs;
  }
};

/// A torus, a surface with edges of three triangles, and a sphere.
Testing::Surface ThreeParts()
{
  return Rotated(Joined(Joined(Torus(24, 14), Moved(ThreeFins(6), { 5.0, 0.0, 0.0 })),
    Moved(Icosphere(2), { 0.0, 0.0, 5.0 })));
}

/// The promises of models whose result does not depend on the numbering.
class NumberingContract : public ModelContract
{
};

/// The promises of models that use a solver for one system.
class AllocationContract : public ModelContract
{
};

/// The promises of models of given data.
class DataModelContract : public ModelContract
{
};

/// The promises of those whose steps lower an energy.
class EnergyContract : public ModelContract
{
};

/// A model that can be moved by itself, and the run that keeps what it refers to.
struct LooseModel
{
  SurfaceDiffusion::Run Run{ SerialFor() };
  Model* Moved = nullptr;

  LooseModel(const ModelKind& kind, const RunInput& input)
  {
    this->Run.Update({ input.Block() }, kind.Make(&this->Moved), Alone, ProgressMonitor());
  }
};

} // namespace

TEST_P(ModelContract, SameBitsInAnyOrderOfSteps)
{
  const CellInput input = this->MakeInput(ThreeParts());
  const int last = this->LastStep();
  this->Set([](TimeSettings& s) { s.GenerateTimeSteps = true; });
  SurfaceDiffusion::Run forward(SerialFor());
  this->Update(forward, input);
  std::vector<std::vector<Values>> expected;
  for (int step = 0; step <= last; ++step)
  {
    expected.push_back(this->ResultsAt(forward, input, step));
  }
  EXPECT_FALSE(expected.back() == expected.front());
  for (const int limit : { 0, 512 }) // one checkpoint, and all
  {
    this->Set([limit](TimeSettings& s) { s.CheckpointMemoryLimit = limit; });
    SurfaceDiffusion::Run jumping(SerialFor());
    this->Update(jumping, input);
    for (const int step : { last, last / 2, 0, last, last - 1 })
    {
      EXPECT_TRUE(
        AreSame(this->ResultsAt(jumping, input, step), expected[static_cast<std::size_t>(step)]))
        << "step " << step << ", limit " << limit;
    }
  }
}

TEST_P(ModelContract, SameBitsFromEveryCheckpoint)
{
  const CellInput input = this->MakeInput(ThreeParts());
  const auto last = static_cast<std::size_t>(this->LastStep());
  LooseModel first(this->Kind, input), second(this->Kind, input), fresh(this->Kind, input);
  Model& model = *first.Moved;
  std::vector<std::vector<double>> checkpoints;
  std::vector<Values> states;
  std::vector<double> energies;
  const auto keep = [&]
  {
    checkpoints.emplace_back(model.CheckpointSize());
    model.Save(checkpoints.back().data());
    states.push_back(model.State());
    energies.push_back(model.Energy());
  };
  keep();
  for (std::size_t step = 0; step < last; ++step)
  {
    model.Advance(ProgressMonitor());
    keep();
  }
  const auto expectStep = [&](Model& other, std::size_t step)
  {
    EXPECT_TRUE(other.State() == states[step]) << "step " << step;
    EXPECT_EQ(other.Energy(), energies[step]) << "step " << step;
  };
  // The last step first, so that nothing fits that the model has from the step before.
  for (std::size_t step = last; step-- > 0;)
  {
    second.Moved->Restore(checkpoints[step].data());
    expectStep(*second.Moved, step);
    second.Moved->Advance(ProgressMonitor());
    expectStep(*second.Moved, step + 1);
  }
  fresh.Moved->Restore(checkpoints[last / 2].data());
  for (std::size_t step = last / 2; step < last; ++step)
  {
    fresh.Moved->Advance(ProgressMonitor());
  }
  expectStep(*fresh.Moved, last);
  EXPECT_EQ(fresh.Moved->Finished(), model.Finished());
}

TEST_P(ModelContract, SameBitsOnThreads)
{
  const CellInput input = this->MakeInput(Plate(70, 1.0)); // several blocks
  const ThreadedFor threads(3);
  SurfaceDiffusion::Run serial(SerialFor()), threaded(threads);
  EXPECT_TRUE(AreSame(this->Compute(serial, input), this->Compute(threaded, input)));
}

TEST_P(NumberingContract, SameResultInAnyNumberingOrientationAndPosture)
{
  const Testing::Surface surface = ThreeParts();
  const std::vector<Index> numbers = Permutation(surface.NumberOfVertices(), 17);
  Testing::Surface renumbered = Renumbered(surface, numbers);
  for (Index t = 0; t < renumbered.NumberOfTriangles(); t += 3)
  {
    std::swap(renumbered.Faces(t, 0), renumbered.Faces(t, 1));
  }
  const CellInput input = this->MakeInput(surface);
  if (!this->Settings->DescribeModel().NeedsDirections && !this->UsesRandomNumbers())
  {
    renumbered = Moved(Rotated(renumbered, 2.0), { 3.0, -2.0, 5.0 }); // numbers belong to places
  }
  CellInput other = this->MakeInput(renumbered);
  const std::vector<Index> rows =
    this->Kind.IsOnCells() ? Permutation(surface.NumberOfTriangles(), 99) : numbers;
  for (Eigen::Index i = 0; i < input.Data.Data.Values.rows(); ++i)
  {
    other.Data.Data.Values.row(rows[static_cast<std::size_t>(i)]) = input.Data.Data.Values.row(i);
  }
  this->Set([](TimeSettings& s) { s.Tolerance = 1e-12; });
  SurfaceDiffusion::Run one(SerialFor()), two(SerialFor());
  const std::vector<Values> ofOne = this->Compute(one, input), ofTwo = this->Compute(two, other);
  const Values &u = ofOne[0], &v = ofTwo[0];
  double largest = 0.0;
  for (Index i = 0; i < surface.NumberOfVertices(); ++i)
  {
    const Eigen::RowVectorXd a = u.row(one.GetBlock(0).Surface->VertexOf(i));
    const Eigen::RowVectorXd b =
      v.row(two.GetBlock(0).Surface->VertexOf(numbers[static_cast<std::size_t>(i)]));
    const bool isOpposite = this->Settings->DescribeModel().StateIsLines && a.dot(b) < 0.0;
    largest = std::max(largest, (a - (isOpposite ? -b : b)).cwiseAbs().maxCoeff());
  }
  const double tolerance = this->NumberingTolerance();
  EXPECT_LT(largest, tolerance * u.cwiseAbs().maxCoeff());
  EXPECT_NEAR(ofOne[1](0, 0), ofTwo[1](0, 0), tolerance * ofOne[1](0, 0));
}

TEST_P(AllocationContract, LaterStepsAllocateNothing)
{
  if (NumberOfAllocations() < 0)
  {
    GTEST_SKIP() << "allocations cannot be counted here";
  }
  // Factorisations are a library's, and multigrid has other levels for another matrix.
  this->Set(
    [this](TimeSettings& s)
    {
      if (this->Kind.Data != Content::Nothing) // the matrices of textures stay
      {
        s.Solver = SolverMethod::ConjugateGradient;
      }
    });
  if (auto* const variation = dynamic_cast<TotalVariationSettings*>(this->Settings.get()))
  {
    variation->StopTolerance = 0.1;
  }
  for (const int components : { 1, 2, 5 })
  {
    if (components > 1 && !this->Kind.HasScalars())
    {
      continue;
    }
    CellInput input = this->MakeInput(Plate(50, 1.0), components); // two blocks
    if (std::dynamic_pointer_cast<DataSettings>(this->Settings))
    {
      input.Data.Fixed.Values.assign(static_cast<std::size_t>(input.Data.Data.Values.rows()), 0);
      std::fill_n(input.Data.Fixed.Values.begin(), 50, 1);
      input.Data.Fixed.OnCells = this->Kind.IsOnCells();
    }
    SurfaceDiffusion::Run run(SerialFor());
    this->Update(run, input);
    Trajectory& path = *run.GetBlock(0).Path;
    path.Reserve(this->LastStep());
    path.Seek(1);
    const auto allocationsTo = [&](int step)
    {
      const long before = NumberOfAllocations();
      path.Seek(step);
      return NumberOfAllocations() - before;
    };
    // Work that no step before has needed, such as that of a second attempt to solve.
    EXPECT_LE(allocationsTo(this->LastStep()), 1) << components;
    for (const int back : { 0, this->LastStep() / 2 })
    {
      path.Seek(back);
      // A model of one step has no later ones: the vectors of its result.
      EXPECT_LE(allocationsTo(this->LastStep()), this->LastStep() == 1 ? 16 : 0)
        << components << " components, after step " << back;
    }
  }
}

TEST_P(ModelContract, ContinuesAfterAnAbortInAnyLoop)
{
  const CellInput input = this->MakeInput(Plate(46, 1.0)); // two blocks of vertices
  AbortedFor loops;
  SurfaceDiffusion::Run reference(loops);
  const std::vector<Values> expected = this->Compute(reference, input);
  const auto endAt = [&](long place) { loops.Left = place; };
  EXPECT_EQ(
    this->ExpectRunsToContinue(-loops.Left, loops, input, ProgressMonitor(), expected, endAt), 1.0);
}

TEST_P(ModelContract, ContinuesAfterAnAbortAtAnyReport)
{
  const CellInput input = this->MakeInput(ThreeParts());
  long left = 0;
  const ProgressMonitor::Callback report = [&](double) { return --left != 0; };
  const ProgressMonitor progress(report);
  SurfaceDiffusion::Run reference(SerialFor());
  const std::vector<Values> expected = this->Compute(reference, input, progress);
  const auto endAt = [&](long place)
  {
    EXPECT_TRUE(place > 0 || left >= 0) << "went on after the abort";
    left = place;
  };
  // The number of reports of a factorisation depends on the time that it takes.
  EXPECT_GT(this->ExpectRunsToContinue(-left, SerialFor(), input, progress, expected, endAt), 0.5);
}

TEST_P(ModelContract, ContinuesAfterWantOfMemoryAtAnyPlace)
{
  if (NumberOfAllocations() < 0)
  {
    GTEST_SKIP() << "allocations cannot be made to fail here";
  }
  const CellInput input = this->MakeInput(ThreeParts());
  SurfaceDiffusion::Run reference(SerialFor());
  const long before = NumberOfAllocations();
  const std::vector<Values> expected = this->Compute(reference, input);
  const long all = NumberOfAllocations() - before;
  // Some algorithms, such as sorting, can do without the memory.
  EXPECT_GT(this->ExpectRunsToContinue(
              all, SerialFor(), input, ProgressMonitor(), expected, FailAllocation),
    0.5);
}

TEST_P(DataModelContract, StartsFromTheDataToTheLastBit)
{
  if (this->Kind.HasUnitVectors() || this->Settings->DescribeModel().Period > 0.0)
  {
    return; // from their directions
  }
  CellInput input = this->MakeInput(ThreeParts());
  input.Data.Data.Values =
    input.Data.Data.Values.array().isNaN().select(100.0, input.Data.Data.Values);
  SurfaceDiffusion::Run run(SerialFor());
  this->Update(run, input);
  EXPECT_TRUE(this->RowsOfData(run, input) == input.Data.Data.Values);
}

TEST_P(DataModelContract, ConstantsStay)
{
  if (this->Settings->DescribeModel().Vectors == VectorType::Tangent)
  {
    return; // no field in space that is constant lies in the surface
  }
  const Eigen::RowVector3d different(-273.15, 0.1, 40.0);
  for (const Testing::Surface& surface :
    { ThreeParts(), Moebius(41, 4), Jittered(Strip(20, 20), 0.015, 0, 1, 0, 1) })
  {
    CellInput input = this->MakeInput(surface);
    for (const Eigen::RowVector3d& constant :
      { different, Eigen::RowVector3d(1e12, 1e12, 1e12), Eigen::RowVector3d(0.0, 0.0, 0.0) })
    {
      const bool isHuge = constant[0] == 1e12; // minimisers take its round-off for contrast
      if (isHuge ? this->UsesSinglePrecision() : this->Kind.HasUnitVectors() && constant.isZero())
      {
        continue;
      }
      for (auto row : input.Data.Data.Values.rowwise())
      {
        if (!std::isnan(row[0]))
        {
          row = constant.head(row.size());
        }
      }
      SurfaceDiffusion::Run run(SerialFor());
      this->Update(run, input);
      const Values start = this->RowsOfData(run, input);
      run.Seek(this->LastStep(), ProgressMonitor());
      const Values change = this->RowsOfData(run, input) - start;
      for (Eigen::Index k = 0; k < change.cols(); ++k)
      {
        const double size =
          (this->MixesComponents() ? start : Values(start.col(k))).cwiseAbs().maxCoeff();
        EXPECT_LE(change.col(k).cwiseAbs().maxCoeff(), 1e-13 * size) << k << " of " << constant;
      }
    }
  }
}

TEST_P(EnergyContract, EnergyNeverGrows)
{
  this->Set([](TimeSettings& s) { s.NumberOfTimeSteps = 6; });
  const CellInput input = this->MakeInput(ThreeParts());
  SurfaceDiffusion::Run run(SerialFor());
  this->Compute(run, input);
  const auto& records = run.GetBlock(0).Path->Records();
  for (std::size_t step = 1; step < records.size(); ++step)
  {
    const double before = records[step - 1].Energy;
    EXPECT_LE(records[step].Energy - before, 1e-12 * before) << "step " << step;
  }
  EXPECT_LT(records.back().Energy, records.front().Energy);
}

TEST_P(DataModelContract, FixedValuesStayToTheLastBit)
{
  CellInput input = this->MakeInput(ThreeParts());
  input.Data.Fixed.Values.assign(static_cast<std::size_t>(input.Data.Data.Values.rows()), 0);
  std::fill_n(input.Data.Fixed.Values.begin(), 50, 1);
  input.Data.Fixed.OnCells = this->Kind.IsOnCells();
  SurfaceDiffusion::Run run(SerialFor());
  this->Update(run, input);
  const auto fixedRows = [&] { return Values(this->RowsOfData(run, input).topRows(50)); };
  const Values start = fixedRows();
  const Values before = run.GetBlock(0).Path->State();
  run.Seek(this->LastStep(), ProgressMonitor());
  EXPECT_TRUE(fixedRows() == start);
  EXPECT_FALSE(run.GetBlock(0).Path->State() == before);
}

TEST_P(DataModelContract, MissingDataAreNotRead)
{
  CellInput input = this->MakeInput(ThreeParts());
  input.Data.Mask.Values.assign(static_cast<std::size_t>(input.Data.Data.Values.rows()), 0);
  std::fill_n(input.Data.Mask.Values.begin(), 50, 1);
  input.Data.Mask.OnCells = this->Kind.IsOnCells();
  const Values state = this->StateOn(input);
  input.Data.Data.Values.topRows(50).array() += 0.125; // within the range of the data
  EXPECT_TRUE(this->StateOn(input) == state);
}

namespace
{
std::vector<ModelKind> DataModelKinds()
{
  std::vector<ModelKind> kinds;
  for (const ModelKind& kind : AllModelKinds())
  {
    const auto settings = kind.Make(nullptr);
    if (std::dynamic_pointer_cast<DataSettings>(settings))
    {
      kinds.push_back(kind);
    }
  }
  return kinds;
}

/// These models but those that do not promise this.
std::vector<ModelKind> Without(Exemption from, std::vector<ModelKind> kinds)
{
  const auto isExempt = [from](const ModelKind& kind) { return kind.From == from; };
  kinds.erase(std::remove_if(kinds.begin(), kinds.end(), isExempt), kinds.end());
  return kinds;
}

/// Also the models of colours with other settings.
std::vector<ModelKind> EnergyKinds()
{
  std::vector<ModelKind> kinds = Without(Exemption::Energy, DataModelKinds());
  for (const char* const colors : { "Opponent", "ChromaticityBrightness" })
  {
    for (const char* const change :
      { "EdgeFunction=Charbonnier", "EdgeFunction=PeronaMalikRational", "ChromaticityExponent=1.5",
        "Discretization=CrouzeixRaviart" })
    {
      const std::string all = change;
      const bool isNumber = all.back() == '5';
      const std::size_t sign = all.find('=');
      kinds.push_back(
        MakeModelKind(ParseKind(colors + (isNumber ? all.substr(0, sign) : all.substr(sign + 1)) +
          " TotalVariation Colors NumberOfTimeSteps=6 AutomaticFidelity=0 ColorModel=" + colors +
          " " + all)));
    }
  }
  return kinds;
}

std::string NameOf(const testing::TestParamInfo<ModelKind>& kind)
{
  return kind.param.Name;
}
}

INSTANTIATE_TEST_SUITE_P(, ModelContract, testing::ValuesIn(AllModelKinds()), NameOf);
INSTANTIATE_TEST_SUITE_P(
  , NumberingContract, testing::ValuesIn(Without(Exemption::Numbering, AllModelKinds())), NameOf);
INSTANTIATE_TEST_SUITE_P(
  , AllocationContract, testing::ValuesIn(Without(Exemption::Allocation, AllModelKinds())), NameOf);
INSTANTIATE_TEST_SUITE_P(, DataModelContract, testing::ValuesIn(DataModelKinds()), NameOf);
INSTANTIATE_TEST_SUITE_P(, EnergyContract, testing::ValuesIn(EnergyKinds()), NameOf);
