// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// MeasureGpu [check | all] [<seconds> [<file> [<threads>]]] compares the solvers of the core with
// a prototype of them on a GPU (Device.h): conjugate gradients, multigrid and the minimiser of
// total variation, on icospheres and on a sphere with meridians, whose triangles are needles at the
// poles. check takes small surfaces only. Each result of the GPU is compared with that of the core
// first; the program fails if one is off. It prints tables, and writes all numbers to the file as
// lines of JSON. After the given number of seconds it leaves out what remains to be measured on one
// thread of the CPU, and after half as many again the surfaces that remain. Times are medians, in
// ms.

#include "Device.h"

#include "NeedleMeshes.h"

#include "Core/Foundation/ThreadPool.h"
#include "Core/Models/TotalVariation/TotalVariationMinimizer.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/Aggregation.h"
#include "Core/Solvers/SolverChoice.h"
#include "Core/Statistics/ValueRange.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <future>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double Now()
{
  using Clock = std::chrono::steady_clock;
  static const Clock::time_point start = Clock::now();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double Median(std::vector<double> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// The median of up to `most` times in ms, within about `seconds`.
template <typename Act>
double Milliseconds(const Act& act, int most = 5, double seconds = 1.0)
{
  std::vector<double> times;
  for (const double begin = Now();
       times.empty() || (static_cast<int>(times.size()) < most && Now() - begin < seconds);)
  {
    const double start = Now();
    act();
    times.push_back(1e3 * (Now() - start));
  }
  return Median(times);
}

/// One line of JSON per measurement, and a table at the end.
class Results
{
public:
  explicit Results(const std::string& path)
    : File(path)
  {
  }

  using Numbers = std::vector<std::pair<std::string, double>>;

  void Add(const std::string& what, const std::string& surface, const Numbers& numbers)
  {
    std::ostringstream line;
    line << "{\"what\": \"" << what << "\", \"surface\": \"" << surface << '"';
    for (const auto& [name, number] : numbers)
    {
      line << ", \"" << name << "\": ";
      std::isfinite(number) ? line << number : line << "null";
    }
    line << "}\n";
    std::fputs(line.str().c_str(), stdout);
    std::fflush(stdout);
    this->File << line.str() << std::flush;
  }

  void Print(const std::string& line) { this->Table += line + "\n"; }
  void PrintTable() const { std::printf("\n%s", this->Table.c_str()); }

  /// The relative difference in the Euclidean norm; more than `most`, or no number, is a failure.
  double Compare(const char* what, const Values& is, const Values& shouldBe, double most)
  {
    const double difference = (is - shouldBe).norm() / shouldBe.norm();
    if (!(difference <= most))
    {
      std::printf("FAILED: %s differs by %g, allowed are %g\n", what, difference, most);
      this->Failures += 1;
    }
    return difference;
  }

  int Failures = 0;

private:
  std::ofstream File;
  std::string Table;
};

std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string Format(const char* format, ...)
{
  char line[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof(line), format, arguments);
  va_end(arguments);
  return line;
}

/// " -" for what was not measured.
std::string Cell(double number)
{
  return std::isnan(number) ? "-" : Format(number < 10.0 ? "%.3g" : "%.0f", number);
}

Gpu::HostRows View(const SparseMatrix& columns)
{
  return { static_cast<int>(columns.cols()), columns.outerIndexPtr(), columns.innerIndexPtr(),
    columns.valuePtr() };
}

/// The levels of Multigrid::MakeLevels(), which it does not show.
struct Hierarchy
{
  std::deque<SparseMatrix> A, Restriction, Prolongation;
  std::deque<Vector> InverseD;
  std::vector<float> Coarsest; ///< the inverse

  Hierarchy(const SparseMatrix& matrix, const ParallelFor& parallel)
  {
    Vector kernel = RootsOfDiagonal(matrix, Reduction::Serial(), parallel);
    const Vector scaling = kernel.cwiseInverse(); // to the last bit: aggregates depend on it
    SparseMatrix current;
    TakePattern(matrix, current, parallel);
    ForEach(parallel, static_cast<Index>(matrix.rows()),
      [&](Index i)
      {
        for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
        {
          current.valuePtr()[slot] =
            matrix.valuePtr()[slot] * (scaling[i] * scaling[matrix.innerIndexPtr()[slot]]);
        }
      });
    for (double strength = 0.08; current.rows() > 500; strength *= 0.5)
    {
      SparseMatrix restriction = SmoothedAggregation(current, strength, kernel, parallel);
      if (static_cast<double>(restriction.rows()) > 0.8 * static_cast<double>(current.rows()))
      {
        break;
      }
      SparseMatrix prolongation = Transposed(restriction, parallel);
      SparseMatrix coarse = GalerkinProduct(current, restriction, prolongation, parallel);
      this->InverseD.emplace_back(current.rows());
      ForEach(parallel, static_cast<Index>(current.rows()),
        [&](Index i)
        {
          double sum = 0.0;
          for (SparseMatrix::InnerIterator entry(current, i); entry; ++entry)
          {
            sum += std::abs(entry.value());
          }
          this->InverseD.back()[i] = 1.0 / sum;
        });
      this->A.emplace_back().swap(current);
      this->Restriction.emplace_back().swap(restriction);
      this->Prolongation.emplace_back().swap(prolongation);
      current.swap(coarse);
    }
    const Eigen::MatrixXd dense(current);
    const Eigen::MatrixXf inverse =
      dense.llt().solve(Eigen::MatrixXd::Identity(dense.rows(), dense.cols())).cast<float>();
    this->Coarsest.assign(inverse.data(), inverse.data() + inverse.size());
  }

  std::vector<Gpu::HostLevel> Levels() const
  {
    std::vector<Gpu::HostLevel> levels;
    for (std::size_t l = 0; l < this->A.size(); ++l)
    {
      // Eigen's columns are rows here: those of R are the rows of P.
      levels.push_back({ View(this->A[l]), View(this->Restriction[l]), View(this->Prolongation[l]),
        this->InverseD[l].data() });
    }
    return levels;
  }
};

struct Problem
{
  std::string Name;
  Surface Input;
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Assembler> Operators;
  CornerWeights Coefficients;
  SparseMatrix Matrix;

  /// Seconds of the mesh, and of the rest.
  void Make(const ParallelFor& parallel, double& mesh, double& pattern)
  {
    const double start = Now();
    this->Mesh = std::make_shared<TriangleMesh>(this->Input.Vertices, this->Input.Faces, parallel);
    mesh = 1e3 * (Now() - start);
    const double second = Now();
    this->Operators = std::make_shared<Assembler>(this->Mesh, parallel);
    this->Operators->TakePattern(this->Matrix, parallel);
    pattern = 1e3 * (Now() - second);
  }

  /// Backward Euler of dt = number h^2.
  void Assemble(double number, const ParallelFor& parallel)
  {
    const double h = this->Mesh->MeanEdgeLength();
    this->Coefficients = CotanWeights(*this->Mesh, parallel);
    this->Operators->Fill(this->Matrix, this->Mesh->ControlAreas(), number * h * h,
      this->Coefficients, nullptr, parallel);
  }

  Index Size() const { return this->Mesh->NumberOfVertices(); }

  /// A cap and noise, different ones in each column.
  Values Data(int columns) const
  {
    Values u = 0.25 * Noise(*this->Mesh, columns);
    for (Index i = 0; i < this->Size(); ++i)
    {
      const Eigen::RowVector3d x = this->Input.Vertices.row(this->Mesh->InputVertex()[i]);
      for (int k = 0; k < columns; ++k)
      {
        u(i, k) += x[k % 3] > 0.1 * k ? 1.0 : 0.0;
      }
    }
    return u;
  }
};

double Share(const SparseMatrix& matrix, const Vector& masses, const ParallelFor& parallel)
{
  return masses.sum() /
    Sum(parallel, static_cast<Index>(matrix.rows()),
      [&](Index i) { return DiagonalEntry(matrix, i); });
}

const double None = std::nan("");

class Measurement
{
public:
  /// patience: of each measurement, in units of the usual one.
  Measurement(Results& results, double seconds, double patience, int threads)
    : Out(results)
    , Pool(threads)
    , Seconds(seconds)
    , Patience(patience)
  {
  }

  /// largest: whether one thread is measured for a few cases only.
  void Measure(Problem& problem, bool isLarge, bool minimizes)
  {
    this->MeasureStages(problem);
    for (const int columns : { 1, 8 })
    {
      const std::vector<double> numbers =
        columns == 8 ? std::vector<double>{ 10.0 } : std::vector<double>{ 1.0, 10.0, 100.0, 1e4 };
      for (const double number : numbers)
      {
        problem.Assemble(number, this->Pool);
        this->MeasureHeat(problem, number, columns, isLarge);
      }
    }
    if (minimizes)
    {
      for (const int columns : { 1, 3 })
      {
        this->MeasureMinimizer(problem, columns, isLarge);
      }
    }
  }

private:
  bool HasTime() const { return Now() < this->Seconds; }

  void MeasureStages(Problem& problem)
  {
    Results::Numbers numbers;
    std::string line = problem.Name + " |";
    for (const bool isSerial : { true, false })
    {
      const ParallelFor& parallel = isSerial ? SerialFor() : this->Pool;
      const std::string suffix = isSerial ? "_1" : "_all";
      double mesh = 0.0;
      double pattern = 0.0;
      problem.Make(parallel, mesh, pattern);
      const double assembly = Milliseconds([&] { problem.Assemble(10.0, parallel); }, 3);
      const auto gradients = MakeConjugateGradientSolver(parallel);
      const double jacobi = Milliseconds([&] { gradients->SetMatrix(problem.Matrix); }, 1);
      const double jacobiAgain = Milliseconds([&] { gradients->SetMatrix(problem.Matrix); }, 3);
      const auto multigrid = MakeMultigridSolver(parallel);
      const double levels = Milliseconds([&] { multigrid->SetMatrix(problem.Matrix); }, 1);
      numbers.insert(numbers.end(),
        { { "mesh" + suffix, mesh }, { "pattern" + suffix, pattern },
          { "assembly" + suffix, assembly }, { "setup_cg" + suffix, jacobi },
          { "setup_cg_again" + suffix, jacobiAgain }, { "setup_multigrid" + suffix, levels } });
      if (!isSerial)
      {
        this->Before = mesh + pattern + assembly;
        this->SetUpJacobi = jacobi;
        this->SetUpMultigrid = levels;
      }
      line += " " + Cell(mesh) + " " + Cell(pattern) + " " + Cell(assembly) + " " + Cell(jacobi) +
        " " + Cell(levels) + " |";
      if (problem.Size() < 1000000)
      {
        const auto direct = MakeCholeskySolver(parallel);
        const double factor = Milliseconds([&] { direct->SetMatrix(problem.Matrix); }, 1);
        const Values b = problem.Mesh->ControlAreas().asDiagonal() * problem.Data(1);
        Values x = b;
        const double solve = Milliseconds([&] { direct->Solve(b, x); }, 3);
        numbers.insert(
          numbers.end(), { { "factor" + suffix, factor }, { "substitution" + suffix, solve } });
        line += " direct " + Cell(factor) + " " + Cell(solve) + " |";
      }
    }
    this->Out.Add("stages", problem.Name, numbers);
    this->Stages.push_back(line);
  }

  struct Core
  {
    double Serial = None, All = None;
    int Iterations = 0;
  };

  /// The solver of the core on one thread, if asked for, and on all.
  template <typename MakeSolver>
  Core MeasureCore(const Problem& problem, const Values& u, double tolerance, bool isSerial,
    const MakeSolver& make)
  {
    Core core;
    const Values b = problem.Mesh->ControlAreas().asDiagonal() * u;
    for (const bool serial : { true, false })
    {
      if (serial && !(isSerial && this->HasTime()))
      {
        continue;
      }
      const auto solver = make(serial ? SerialFor() : static_cast<const ParallelFor&>(this->Pool));
      solver->SetLimits({ tolerance, 100000 });
      solver->SetMatrix(problem.Matrix);
      Values x;
      std::vector<double> times;
      for (const double begin = Now(); times.empty() ||
           (times.size() < 5 && Now() - begin < this->Patience * (serial ? 0.2 : 0.4));)
      {
        x = u;
        const double start = Now();
        core.Iterations = solver->Solve(b, x).Iterations;
        times.push_back(1e3 * (Now() - start));
      }
      (serial ? core.Serial : core.All) = Median(times);
    }
    return core;
  }

  void MeasureHeat(const Problem& problem, double number, int columns, bool isLarge)
  {
    const Values u = problem.Data(columns);
    const Vector& masses = problem.Mesh->ControlAreas();
    const Values b = masses.asDiagonal() * u;
    const auto bytesOfData = static_cast<double>(u.size() * sizeof(double));

    // The device, and a second time without its first calls
    double setUp = None;
    std::unique_ptr<Gpu::HeatSolver> device;
    for (int i = 0; i < 2; ++i)
    {
      device.reset();
      const double start = Now();
      device = std::make_unique<Gpu::HeatSolver>(
        View(problem.Matrix), masses.data(), Share(problem.Matrix, masses, this->Pool));
      setUp = 1e3 * (Now() - start);
    }
    const double startOfLevels = Now();
    const Hierarchy hierarchy(problem.Matrix, this->Pool);
    const double makeLevels = 1e3 * (Now() - startOfLevels);
    device->Upload(u.data(), columns); // allocates
    const double sendLevels =
      Milliseconds([&] { device->SetHierarchy(hierarchy.Levels(), hierarchy.Coarsest); }, 2);
    Values x(u.rows(), u.cols());
    x.setZero(); // touches its pages
    const double up = Milliseconds([&] { device->Upload(u.data(), columns); }, 9);
    const double down = Milliseconds([&] { device->Download(x.data()); }, 9);
    double* const pinned = Gpu::AllocatePinned(static_cast<std::size_t>(u.size()));
    std::copy(u.data(), u.data() + u.size(), pinned);
    const double pinnedUp = Milliseconds([&] { device->Upload(pinned, columns); }, 9);
    const double pinnedDown = Milliseconds([&] { device->Download(pinned); }, 9);
    Gpu::FreePinned(pinned);
    device->Upload(u.data(), columns);

    // One cycle, compared with that of the core
    const auto multigrid = MakeMultigridSolver(this->Pool);
    multigrid->SetMatrix(problem.Matrix);
    Values z(u.rows(), u.cols());
    multigrid->Precondition(b, z);
    device->Upload(b.data(), columns);
    device->Cycle(1);
    device->Download(x.data());
    const double ofCycle = this->Out.Compare("cycle", x, z, 1e-4);
    const double coreCycle = Milliseconds([&] { multigrid->Precondition(b, z); }, 5, 0.3);
    device->Cycle(20);
    const double cycle = device->Cycle(20).Milliseconds;
    if (number == 10.0)
    {
      double rows = 0.0;
      for (const SparseMatrix& a : hierarchy.A)
      {
        rows += static_cast<double>(a.rows());
      }
      this->AddTraffic(problem, columns, "cycle",
        8.0 * device->EntriesOfLevels() + (96.0 * columns + 12.0) * rows, cycle);
    }
    device->Upload(u.data(), columns);
    this->Out.Add("device", problem.Name,
      { { "vertices", problem.Size() }, { "number", number }, { "columns", columns },
        { "bytes", bytesOfData }, { "setup", setUp }, { "make_levels", makeLevels },
        { "levels", static_cast<double>(hierarchy.A.size()) },
        { "coarsest", std::sqrt(static_cast<double>(hierarchy.Coarsest.size())) },
        { "send_levels", sendLevels }, { "up", up }, { "down", down }, { "pinned_up", pinnedUp },
        { "pinned_down", pinnedDown }, { "cycle", cycle }, { "core_cycle_all", coreCycle },
        { "cycle_difference", ofCycle }, { "entries", device->EntriesOfMatrix() },
        { "entries_of_cycle", device->EntriesOfLevels() } });
    if (number == 10.0)
    {
      this->Transfers.push_back(Format("%s k=%d | %s %s %s %s | %s %s %s %s | %s %s",
        problem.Name.c_str(), columns, Cell(setUp).c_str(), Cell(makeLevels).c_str(),
        Cell(sendLevels).c_str(), Cell(static_cast<double>(hierarchy.A.size())).c_str(),
        Cell(up).c_str(), Cell(down).c_str(), Cell(pinnedUp).c_str(), Cell(pinnedDown).c_str(),
        Cell(coreCycle).c_str(), Cell(cycle).c_str()));
    }

    // Solutions
    multigrid->SetLimits({ 1e-12, 1000 });
    Values exact = u;
    const double residualOfExact = multigrid->Solve(b, exact).Residual;
    // A = M + dt K has x.A x >= x.M x >= x.D x / kappa, with its diagonal D and kappa the largest
    // d_i / m_i. The error e of a residual r, A e = r, is hence |e|_M <= |e|_A <= kappa^1/2
    // |D^-1/2 r|. Solvers bound |D^-1/2 r| by a share of |D^-1/2 b|.
    const Vector roots = masses.cwiseSqrt();
    double kappa = 0.0;
    double squareOfB = 0.0;
    for (Index i = 0; i < problem.Size(); ++i)
    {
      const double diagonal = DiagonalEntry(problem.Matrix, i);
      kappa = std::max(kappa, diagonal / masses[i]);
      squareOfB += b.row(i).squaredNorm() / diagonal;
    }
    const Values exactByAreas = roots.asDiagonal() * exact;
    const double errorOfResidual = std::sqrt(kappa * squareOfB) / exactByAreas.norm();
    for (const double tolerance : { 1e-6, 1e-10 })
    {
      const bool isFew = isLarge && (columns > 1 || tolerance < 1e-6);
      const Core gradients = number > 1000.0 && problem.Size() > 200000
        ? Core()
        : this->MeasureCore(problem, u, tolerance, !isFew,
            [](const ParallelFor& p) { return MakeConjugateGradientSolver(p); });
      const Core cycles = this->MeasureCore(
        problem, u, tolerance, !isFew, [](const ParallelFor& p) { return MakeMultigridSolver(p); });
      Results::Numbers numbers = { { "vertices", problem.Size() }, { "number", number },
        { "columns", columns }, { "tolerance", tolerance }, { "cg_1", gradients.Serial },
        { "cg_all", gradients.All }, { "cg_iterations", gradients.Iterations },
        { "multigrid_1", cycles.Serial }, { "multigrid_all", cycles.All },
        { "multigrid_iterations", cycles.Iterations } };
      std::string line = Format("%s k=%d c=%g %g | %s %s (%d) | %s %s (%d) |", problem.Name.c_str(),
        columns, number, tolerance, Cell(gradients.Serial).c_str(), Cell(gradients.All).c_str(),
        gradients.Iterations, Cell(cycles.Serial).c_str(), Cell(cycles.All).c_str(),
        cycles.Iterations);
      double fastest = 1e300;
      double setUpOfFastest = 0.0;
      constexpr const char* names[] = { "gpu_double", "gpu_mixed", "gpu_multigrid" };
      for (const Gpu::SolveMethod method :
        { Gpu::SolveMethod::Double, Gpu::SolveMethod::Mixed, Gpu::SolveMethod::Multigrid })
      {
        const std::string name = names[static_cast<int>(method)];
        std::vector<double> times;
        Gpu::SolveResult result;
        for (const double begin = Now();
             times.size() < 3 || (times.size() < 21 && Now() - begin < 0.3 * this->Patience);)
        {
          result = device->Solve(method, tolerance, 20000);
          times.push_back(result.Milliseconds);
        }
        device->Download(x.data());
        const double most = result.Converged
          ? (std::min(result.Residual, 2.0 * tolerance) + residualOfExact) * errorOfResidual
          : std::numeric_limits<double>::infinity();
        const double difference =
          this->Out.Compare(name.c_str(), roots.asDiagonal() * x, exactByAreas, most);
        const double median = Median(times);
        numbers.insert(numbers.end(),
          { { name, median }, { name + "_iterations", result.Iterations },
            { name + "_residual", result.Residual }, { name + "_converged", result.Converged },
            { name + "_difference", difference }, { name + "_most", most } });
        line += Format(" %s (%d%s)", Cell(median).c_str(), result.Iterations,
          result.Converged ? "" : " stalled");
        const bool isMultigrid = method == Gpu::SolveMethod::Multigrid;
        if (!isMultigrid && tolerance == 1e-10 && (number == 100.0 || columns > 1))
        {
          // Per iteration the matrix once, p, q; q and r twice; r, and y and p twice
          const double size = method == Gpu::SolveMethod::Double ? 8.0 : 4.0;
          const double bytes = (size + 4.0) * device->EntriesOfMatrix() +
            10.0 * size * columns * static_cast<double>(problem.Size());
          this->AddTraffic(
            problem, columns, name + " iteration", bytes, median / result.Iterations);
        }
        const double begin = setUp + (isMultigrid ? makeLevels + sendLevels : 0.0);
        if (result.Converged && begin + median < setUpOfFastest + fastest)
        {
          fastest = median;
          setUpOfFastest = begin;
        }
      }
      // What a filter would do: the fastest first call of each
      const double gradientsFirst = this->SetUpJacobi + gradients.All;
      const double cyclesFirst = this->SetUpMultigrid + cycles.All;
      const bool takesCycles = !(gradientsFirst <= cyclesFirst);
      const double coreFirst = this->Before + (takesCycles ? cyclesFirst : gradientsFirst);
      const double coreNext = takesCycles ? cycles.All : gradients.All;
      const double gpuFirst = this->Before + setUpOfFastest + up + fastest + down;
      const double gpuNext = up + fastest + down;
      numbers.insert(numbers.end(),
        { { "core_first", coreFirst }, { "core_next", coreNext }, { "gpu_first", gpuFirst },
          { "gpu_next", gpuNext } });
      line += Format(" | %s %s | %s %s", Cell(coreFirst).c_str(), Cell(gpuFirst).c_str(),
        Cell(coreNext).c_str(), Cell(gpuNext).c_str());
      this->Out.Add("heat", problem.Name, numbers);
      this->Heat.push_back(line);
    }
  }

  /// bytes: the least that must be moved in so many ms.
  void AddTraffic(
    const Problem& problem, int columns, const std::string& what, double bytes, double milliseconds)
  {
    const double speed = 1e-6 * bytes / milliseconds;
    this->Out.Add("traffic", problem.Name,
      { { "columns", columns }, { what + ", ms", milliseconds }, { "MB", 1e-6 * bytes },
        { "GB_per_s", speed } });
    this->Traffic.push_back(Format("%s k=%d %s: %s us, %s MB, %.0f GB/s", problem.Name.c_str(),
      columns, what.c_str(), Cell(1e3 * milliseconds).c_str(), Cell(1e-6 * bytes).c_str(), speed));
  }

  void MeasureMinimizer(const Problem& problem, int columns, bool isLarge)
  {
    const TriangleMesh& mesh = *problem.Mesh;
    const Values f = problem.Data(columns);
    const double mu = 3.0 / mesh.MeanEdgeLength();
    const Index n = problem.Size();
    const Vector quadraticAreas = mu * mesh.ControlAreas();
    TotalVariationMinimizer::Settings settings;
    settings.Function = { EdgeFunctionKind::TotalVariation, 0.0, 1.0 };
    settings.StopTolerance = 1e-3;
    const auto run =
      [&](const ParallelFor& parallel, int most, double& setUp, double& time, Values& u)
    {
      const double start = Now();
      settings.MaximumNumberOfIterations = most;
      TotalVariationMinimizer minimizer(problem.Operators,
        std::make_shared<GradientMaps>(problem.Mesh), Values::Constant(n, 1, mu), Vector::Zero(n),
        Flags::Constant(n, false), f, settings, parallel);
      setUp = 1e3 * (Now() - start);
      u = f;
      const double second = Now();
      const auto report = minimizer.Minimize(f, f, u);
      time = 1e3 * (Now() - second);
      return report;
    };

    const double start = Now();
    std::vector<TriangleMesh::Shape> listed;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      listed.push_back(mesh.Shapes()[t]);
    }
    static_assert(sizeof(TriangleMesh::Shape) == 4 * sizeof(double), "Shapes are four numbers");
    const auto* const shapes = reinterpret_cast<const double*>(listed.data());
    Gpu::Minimizer device({ n, mesh.NumberOfTriangles(), mesh.TriangleVertices().data(), shapes,
                            mesh.VertexCornersBegin().data(), mesh.VertexCorners().data(),
                            problem.Matrix.outerIndexPtr(), problem.Matrix.innerIndexPtr() },
      quadraticAreas.data());
    const double gpuSetUp = 1e3 * (Now() - start);
    device.Upload(f.data(), columns);
    const double up = Milliseconds([&] { device.Upload(f.data(), columns); }, 9);
    const double typical = TypicalRange(f, Reduction::Serial());

    // The same iterations, then to the same gap
    Values u, x(f.rows(), f.cols());
    double setUp = None;
    double time = None;
    run(this->Pool, 10, setUp, time, u);
    device.Minimize(typical, 1e-9, 10);
    device.Download(x.data());
    const double after10 = this->Out.Compare("ten iterations of the minimiser", x, u, 1e-3);
    std::vector<double> setUps, times;
    TotalVariationMinimizer::Report core;
    for (const double begin = Now();
         times.empty() || (times.size() < 3 && Now() - begin < 0.7 * this->Patience);)
    {
      core = run(this->Pool, 10000, setUp, time, u);
      setUps.push_back(setUp);
      times.push_back(time);
    }
    double serialSetUp = None;
    double serial = None;
    if (this->HasTime() && !(isLarge && columns > 1))
    {
      run(SerialFor(), 10000, serialSetUp, serial, u);
    }
    std::vector<double> gpuTimes, sweeps;
    Gpu::Minimizer::Report report;
    for (int i = 0; i < 9; ++i)
    {
      report = device.Minimize(typical, settings.StopTolerance, 10000);
      gpuTimes.push_back(report.Milliseconds);
      sweeps.push_back(report.SweepMilliseconds / report.Iterations);
    }
    const double down = Milliseconds([&] { device.Download(x.data()); }, 9);
    // A gap of 1e-3 of E bounds mu/2 |u - u*|^2.
    const double difference = this->Out.Compare("minimum", x, u, 3e-2);
    if (report.NeedsDouble || !(report.Gap <= settings.StopTolerance))
    {
      std::printf("FAILED: the minimiser ended at a gap of %g\n", report.Gap);
      this->Out.Failures += 1;
    }
    const double all = Median(times);
    const double gpu = Median(gpuTimes);
    const double sweep = Median(sweeps);
    const auto triangles = static_cast<double>(mesh.NumberOfTriangles());
    // Numbers, map and W of a triangle, its corners written and read, and u; then vertices
    const double inner = static_cast<double>(report.InnerIterations) / report.Iterations;
    const auto entries = static_cast<double>(problem.Matrix.nonZeros() - n);
    this->AddTraffic(problem, columns, "minimiser's sweep",
      triangles * (32.0 + 12.0 + 40.0 * columns) + n * (12.0 + 40.0 * columns) +
        inner * (8.0 * entries + 40.0 * columns * n),
      sweep);
    this->Out.Add("minimiser", problem.Name,
      { { "vertices", n }, { "columns", columns }, { "core_iterations", core.Iterations },
        { "core_gap", core.Gap }, { "core_setup_1", serialSetUp }, { "core_1", serial },
        { "core_setup_all", Median(setUps) }, { "core_all", all },
        { "gpu_iterations", report.Iterations }, { "gpu_gap", report.Gap },
        { "gpu_inner_iterations", report.InnerIterations }, { "gpu_setup", gpuSetUp },
        { "gpu", gpu }, { "gpu_sweep", sweep }, { "up", up }, { "down", down },
        { "difference_after_10", after10 }, { "difference", difference } });
    this->Minimizers.push_back(
      Format("%s k=%d | %s + %s, %s + %s (%d) | %s + %s (%d, %d inner) sweep %s | %s %s",
        problem.Name.c_str(), columns, Cell(serialSetUp).c_str(), Cell(serial).c_str(),
        Cell(Median(setUps)).c_str(), Cell(all).c_str(), core.Iterations, Cell(gpuSetUp).c_str(),
        Cell(gpu).c_str(), report.Iterations, report.InnerIterations, Cell(sweep).c_str(),
        Cell(up).c_str(), Cell(down).c_str()));
  }

public:
  void Print() const
  {
    const auto print = [&](const char* title, const std::vector<std::string>& lines)
    {
      this->Out.Print(std::string("\n") + title);
      for (const std::string& line : lines)
      {
        this->Out.Print(line);
      }
    };
    print("CPU: mesh, pattern, assembly, set-up of conjugate gradients and multigrid on one thread "
          "| all; direct: factor, substitution",
      this->Stages);
    print("device: set-up, making levels, sending levels, their number | up, down, pinned up, down "
          "| cycle of the core on all threads, of the device",
      this->Transfers);
    print("heat: core on one thread, all (iterations): conjugate gradients | multigrid | device: "
          "double, mixed, multigrid | first call, core and device | further call",
      this->Heat);
    print("least traffic", this->Traffic);
    print("minimiser to a gap of 1e-3: core set-up + time on one thread, all | device | up, down",
      this->Minimizers);
  }

private:
  Results& Out;
  const ThreadPool Pool;
  const double Seconds;
  const double Patience;
  double Before = 0.0, SetUpJacobi = 0.0, SetUpMultigrid = 0.0; ///< of the core, all threads
  std::vector<std::string> Stages, Transfers, Heat, Traffic, Minimizers;
};

} // namespace

int main(int argc, char** argv)
{
  const bool isCheck = argc > 1 && std::string(argv[1]) == "check";
  const double seconds = argc > 2 ? std::atof(argv[2]) : 150.0;
  const int threads = argc > 4
    ? std::atoi(argv[4])
    : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  Results results(argc > 3 ? argv[3] : "gpu.jsonl");
  try
  {
    Now();
    double context = 0.0;
    const std::string name = Gpu::StartDevice(context);
    const Gpu::Bandwidth copies = Gpu::MeasureBandwidth(isCheck ? 1 << 24 : 1 << 28);
    const double barrier = Gpu::MeasureBarrier();
    results.Print(Format("%s; context %.0f ms; copies in GB/s: device %.0f, pageable %.1f up %.1f "
                         "down, pinned %.1f up %.1f down; barrier %.2f us; %d threads",
      name.c_str(), 1e3 * context, copies.OnDevice, copies.PageableUp, copies.PageableDown,
      copies.PinnedUp, copies.PinnedDown, barrier, threads));
    results.Add("machine", name,
      { { "context", 1e3 * context }, { "on_device", copies.OnDevice },
        { "pageable_up", copies.PageableUp }, { "pageable_down", copies.PageableDown },
        { "pinned_up", copies.PinnedUp }, { "pinned_down", copies.PinnedDown },
        { "barrier_us", barrier }, { "threads", threads } });

    Measurement measurement(results, seconds, isCheck ? 0.1 : 1.0, threads);
    struct Case
    {
      std::string Name;
      bool IsLarge, Minimizes;
      std::future<Surface> Input;
    };
    std::vector<Case> cases;
    const auto add = [&](const std::string& ofCase, bool isLarge, bool minimizes, auto make) {
      cases.push_back({ ofCase, isLarge, minimizes, std::async(std::launch::async, make) });
    };
    if (isCheck)
    {
      add("icosphere 10,242", false, true, [] { return Icosphere(5); });
      add("needles 16,386", false, false, [] { return LatitudeLongitudeSphere(128, 128); });
    }
    else
    {
      add("icosphere 163,842", false, true, [] { return Icosphere(7); });
      add("icosphere 655,362", false, true, [] { return Icosphere(8); });
      add("icosphere 2,621,442", true, true, [] { return Icosphere(9); });
      add("needles 1,048,578", true, false, [] { return LatitudeLongitudeSphere(1024, 1024); });
    }
    for (Case& one : cases)
    {
      one.Input.wait(); // all of them before the first measurement
    }
    for (Case& one : cases)
    {
      if (Now() > 1.5 * seconds)
      {
        results.Print("no time left for " + one.Name);
        continue;
      }
      Problem problem;
      problem.Name = one.Name;
      problem.Input = one.Input.get();
      measurement.Measure(problem, one.IsLarge, one.Minimizes);
      std::printf("%.0f s after %s\n", Now(), one.Name.c_str());
    }
    measurement.Print();
  }
  catch (const std::exception& error)
  {
    std::printf("FAILED: %s\n", error.what());
    ++results.Failures;
  }
  results.Print(results.Failures == 0 ? "all results agree with the core"
                                      : Format("%d FAILURES", results.Failures));
  results.PrintTable();
  return results.Failures == 0 ? 0 : 1;
}
