// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Measures two time steps on a torus that is distributed over processes, one piece per process:
///
///     mpiexec -n <processes> ScaleProcesses <vertices in all, or per process with "weak"> [weak]
///         [<time step in natural units> [heat | turing | harmonic | tv | minimum]]
///
/// For conjugate gradients with the Jacobi preconditioner and, if the model allows it, with
/// multigrid, the program prints: vertices, seconds of the first update (identification of
/// interface vertices, assembly, set-up, solve) and of a second step alone, iterations, interface
/// vertices, bytes that the busiest process sends per matrix-vector product, and its memory.
/// "minimum" is total variation with TimeIntegrator Implicit.
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

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

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

/// Columns begin .. end of the `around` columns of a torus, each of `along` points. Neighbouring
/// pieces share their end columns.
vtkSmartPointer<vtkPolyData> Piece(
  vtkIdType begin, vtkIdType end, vtkIdType around, vtkIdType along)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> data;
  data->SetName("f");
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("v");
  vectors->SetNumberOfComponents(3);
  const double turn = 2.0 * std::acos(-1.0);
  const bool closed = end - begin == around;
  for (vtkIdType i = begin; i <= (closed ? end - 1 : end); ++i)
  {
    for (vtkIdType j = 0; j < along; ++j)
    {
      const double a = turn * static_cast<double>(i % around) / static_cast<double>(around);
      const double b = turn * static_cast<double>(j) / static_cast<double>(along);
      const double r = 4.0 + std::cos(b);
      points->InsertNextPoint(r * std::cos(a), r * std::sin(a), std::sin(b));
      const double noise = std::sin(91.0 * a + 67.0 * b);
      data->InsertNextValue(std::sin(7.0 * a) * std::cos(5.0 * b) + noise);
      vectors->InsertNextTuple3(std::cos(a) + noise, std::sin(a), std::sin(b) + noise);
    }
  }
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType i = 0; i < end - begin; ++i)
  {
    for (vtkIdType j = 0; j < along; ++j)
    {
      const vtkIdType next = (j + 1) % along;
      const vtkIdType after = closed ? (i + 1) % around : i + 1;
      const vtkIdType q[4] = { i * along + j, after * along + j, after * along + next,
        i * along + next };
      triangles->InsertNextCell({ q[0], q[1], q[2] });
      triangles->InsertNextCell({ q[0], q[2], q[3] });
    }
  }
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  piece->SetPoints(points);
  piece->SetPolys(triangles);
  piece->GetPointData()->SetScalars(data);
  piece->GetPointData()->AddArray(vectors);
  return piece;
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
  const bool weak = argc > 2 && std::string(argv[2]) == "weak";
  const double all = (argc > 1 ? std::atof(argv[1]) : 1e5) * (weak ? count : 1);
  const int next = weak ? 3 : 2;
  const double step = argc > next ? std::atof(argv[next]) : 10.0;
  const std::string model = argc > next + 1 ? argv[next + 1] : "heat";

  const auto along = static_cast<vtkIdType>(std::sqrt(all / 4.0));
  const vtkIdType around = 4 * along;
  const double before = PeakMemory();
  const auto piece = Piece(around * rank / count, around * (rank + 1) / count, around, along);
  const double ofInput = PeakMemory();
  for (const bool multigrid : { false, true })
  {
    if (multigrid && (model == "tv" || model == "minimum"))
    {
      continue;
    }
    const Filter filter = MakeFilter(model);
    filter->SetInputData(piece);
    filter->SetTimeStep(step);
    filter->SetGenerateTimeSteps(true);
    filter->SetNumberOfTimeSteps(2);
    filter->SetMaximumNumberOfIterations(100000);
    filter->SetTolerance(1e-8);
    multigrid ? filter->SetSolverToMultigrid() : filter->SetSolverToConjugateGradient();
    double seconds[3];
    int iterations = 0;
    for (int n = 0; n < 3; ++n)
    {
      controller->Barrier();
      const double start = Seconds();
      filter->UpdateInformation();
      filter->UpdateTimeStep(n * step);
      controller->Barrier();
      seconds[n] = Seconds() - start;
      iterations = static_cast<int>(filter->GetNumberOfIterations());
    }
    const double mine[2] = { PeakMemory() - before, ofInput - before };
    double most[2];
    controller->AllReduce(mine, most, 2, vtkCommunicator::MAX_OP);
    if (rank == 0)
    {
      std::cout << count << " processes, " << around * along << " vertices, " << model << ", dt "
                << step << ", " << (multigrid ? "multigrid" : "Jacobi") << ": surface "
                << seconds[0] << " s, first step (with set-up) " << seconds[1] << " s, second "
                << seconds[2] << " s, iterations of both " << iterations << ", on interfaces "
                << (count > 1 ? count * along : 0) << " vertices, sent per product "
                << (count > 1 ? 2 * along * 8 : 0) << " bytes per process, memory " << most[0]
                << " MiB of which input " << most[1] << "\n";
    }
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return EXIT_SUCCESS;
}
