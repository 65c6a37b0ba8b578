// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Measures two time steps on a torus that is distributed over processes, one piece per process:
///
///     mpiexec -n <processes> ScaleProcesses <vertices> [weak] [tiles] [<time step>]
///         [heat | turing | harmonic | tv | minimum] [automatic]
///
/// vertices: in all, or per process with "weak". tiles: pieces in both directions, slabs without
/// it. time step: in natural units. "minimum" is total variation with TimeIntegrator Implicit.
///
/// For conjugate gradients with the Jacobi preconditioner and, if the model allows it, with
/// multigrid, or for the solver that Automatic selects alone, the program prints: seconds of the
/// surface (identification of interface vertices, assembly), of the first step with its set-up and
/// of a second step alone, iterations of both steps, what the busiest process sends in an iteration
/// of the second step, and its memory.
#include "MessageCounts.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkTuringTextureFilter.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkMPIController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

using SurfaceDiffusion::MessageCounts;

namespace
{

double Seconds()
{
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// The peak memory of this process in MiB.
double PeakMemory()
{
  std::ifstream status("/proc/self/status");
  double kilobytes = 0.0;
  for (std::string word; status >> word;)
  {
    if (word == "VmHWM:")
    {
      status >> kilobytes;
    }
  }
  return kilobytes / 1024.0;
}

/// A part of the columns, or of the points of a column, of a torus: Begin .. End of Count. The next
/// part begins with the last points of this one.
struct Range
{
  vtkIdType Begin, End, Count;

  Range(int part, int parts, vtkIdType count)
    : Begin(count * part / parts)
    , End(count * (part + 1) / parts)
    , Count(count)
  {
  }
  bool IsClosed() const { return this->End - this->Begin == this->Count; }
  vtkIdType NumberOfPoints() const { return this->End - this->Begin + (this->IsClosed() ? 0 : 1); }
  vtkIdType After(vtkIdType i) const { return (i + 1) % this->NumberOfPoints(); }
  double Angle(vtkIdType i) const
  {
    const vtkIdType number = (this->Begin + i) % this->Count;
    return 2.0 * std::acos(-1.0) * static_cast<double>(number) / static_cast<double>(this->Count);
  }
};

vtkSmartPointer<vtkPolyData> Piece(const Range& around, const Range& along)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> data;
  data->SetName("f");
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("v");
  vectors->SetNumberOfComponents(3);
  const vtkIdType perColumn = along.NumberOfPoints();
  for (vtkIdType i = 0; i < around.NumberOfPoints(); ++i)
  {
    for (vtkIdType j = 0; j < perColumn; ++j)
    {
      const double a = around.Angle(i);
      const double b = along.Angle(j);
      const double r = 4.0 + std::cos(b);
      points->InsertNextPoint(r * std::cos(a), r * std::sin(a), std::sin(b));
      const double noise = std::sin(91.0 * a + 67.0 * b);
      data->InsertNextValue(std::sin(7.0 * a) * std::cos(5.0 * b) + noise);
      vectors->InsertNextTuple3(std::cos(a) + noise, std::sin(a), std::sin(b) + noise);
    }
  }
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType i = 0; i < around.End - around.Begin; ++i)
  {
    for (vtkIdType j = 0; j < along.End - along.Begin; ++j)
    {
      const vtkIdType here = i * perColumn;
      const vtkIdType after = around.After(i) * perColumn;
      const vtkIdType next = along.After(j);
      triangles->InsertNextCell({ here + j, after + j, after + next });
      triangles->InsertNextCell({ here + j, after + next, here + next });
    }
  }
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  piece->SetPoints(points);
  piece->SetPolys(triangles);
  piece->GetPointData()->SetScalars(data);
  piece->GetPointData()->AddArray(vectors);
  return piece;
}

/// The number of rows of tiles that are nearly square, on a torus four times as long as wide.
int RowsOfTiles(int count)
{
  int rows = std::max(1, static_cast<int>(std::sqrt(count / 4.0)));
  while (count % rows != 0)
  {
    --rows;
  }
  return rows;
}

using Filter = vtkSmartPointer<vtkSurfaceDiffusionAlgorithm>;

Filter MakeFilter(const std::string& model)
{
  if (model == "turing")
  {
    return vtkSmartPointer<vtkTuringTextureFilter>::New();
  }
  if (model == "harmonic")
  {
    const auto map = vtkSmartPointer<vtkHarmonicMapFilter>::New();
    map->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "v");
    return map;
  }
  if (model == "tv" || model == "minimum")
  {
    const auto tv = vtkSmartPointer<vtkIntrinsicTVFilter>::New();
    tv->SetTimeIntegrator(model == "tv" ? vtkSurfaceDiffusionAlgorithm::TIME_INTEGRATOR_FIRST_ORDER
                                        : vtkSurfaceDiffusionAlgorithm::TIME_INTEGRATOR_IMPLICIT);
    return tv;
  }
  const auto heat = vtkSmartPointer<vtkFVMHeatFilter>::New();
  heat->SetTimeIntegratorToFirstOrder();
  return heat;
}

} // namespace

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  const int rank = controller->GetLocalProcessId();
  const int count = controller->GetNumberOfProcesses();
  double vertices = 1e5;
  double step = 10.0;
  bool weak = false, inTiles = false, automatic = false;
  std::string model = "heat";
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    weak = weak || word == "weak";
    inTiles = inTiles || word == "tiles";
    automatic = automatic || word == "automatic";
    const double number = std::atof(argv[i]);
    if (number > 0.0)
    {
      (i == 1 ? vertices : step) = number;
    }
    else if (word != "weak" && word != "tiles" && word != "automatic")
    {
      model = word;
    }
  }

  const auto wide = static_cast<vtkIdType>(std::sqrt(vertices * (weak ? count : 1) / 4.0));
  const vtkIdType longSide = 4 * wide;
  const int rows = inTiles ? RowsOfTiles(count) : 1;
  const Range around(rank / rows, count / rows, longSide);
  const Range along(rank % rows, rows, wide);
  const double before = PeakMemory();
  const auto piece = Piece(around, along);
  const double ofInput = PeakMemory();
  using Solver = vtkSurfaceDiffusionAlgorithm;
  std::vector<int> solvers = { Solver::SOLVER_AUTOMATIC };
  if (!automatic)
  {
    solvers = { Solver::SOLVER_CONJUGATE_GRADIENT, Solver::SOLVER_MULTIGRID };
    solvers.resize(model == "tv" || model == "minimum" ? 1 : 2);
  }
  for (const int solver : solvers)
  {
    const Filter filter = MakeFilter(model);
    filter->SetInputData(piece);
    filter->SetTimeStep(step);
    filter->SetGenerateTimeSteps(true);
    filter->SetNumberOfTimeSteps(2);
    filter->SetMaximumNumberOfIterations(100000);
    filter->SetTolerance(1e-8);
    filter->SetSolver(solver);
    double seconds[3];
    double iterations[3];
    MessageCounts counts;
    for (int n = 0; n < 3; ++n)
    {
      controller->Barrier();
      counts = MessageCounts::OfThisProcess();
      const double start = Seconds();
      filter->UpdateInformation();
      filter->UpdateTimeStep(n * step);
      controller->Barrier();
      seconds[n] = Seconds() - start;
      iterations[n] = static_cast<double>(filter->GetNumberOfIterations());
    }
    const double ofLast = std::max(1.0, iterations[2] - iterations[1]);
    const MessageCounts& now = MessageCounts::OfThisProcess();
    const double mine[] = { PeakMemory() - before, ofInput - before,
      (now.Messages - counts.Messages) / ofLast, (now.Bytes - counts.Bytes) / ofLast,
      (now.Collectives - counts.Collectives) / ofLast,
      (now.CollectiveBytes - counts.CollectiveBytes) / ofLast,
      (now.Barriers - counts.Barriers) / ofLast };
    double most[7];
    controller->AllReduce(mine, most, 7, vtkCommunicator::MAX_OP);
    if (rank == 0)
    {
      std::cout << count << " processes (" << count / rows << " x " << rows << "), "
                << longSide * wide << " vertices, " << model << ", dt " << step << ", "
                << filter->GetSolverAsString() << ": surface " << seconds[0]
                << " s, first step (with set-up) " << seconds[1] << " s, second " << seconds[2]
                << " s, iterations of both " << iterations[2] << "; the busiest process: memory "
                << most[0] << " MiB of which input " << most[1] << ", in an iteration " << most[2]
                << " messages of " << most[3] << " bytes, " << most[4]
                << " collective operations with " << most[5] << " bytes, " << most[6]
                << " barriers\n";
    }
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return EXIT_SUCCESS;
}
