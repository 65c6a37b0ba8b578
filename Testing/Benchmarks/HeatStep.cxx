// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// HeatStep --task heat --mesh <m.off> --t <t> --u0 <file> --out <file>
//          [--solver Automatic|Direct|ConjugateGradient|Multigrid]
//
// One backward Euler step (M + t K) u = M u0 to a relative residual of 1e-8. The files u0 and out
// contain raw doubles, one per vertex of the mesh. The program prints a line of JSON: CPU seconds
// of mesh and matrix (assembly_s), of the factor or multigrid hierarchy (setup_s) and of the solve
// (solve_s), the peak memory in addition to the mesh (peak_mib), and the solver (version).

#include "HeatSystem.h"
#include "ProcessTime.h"

#include "Core/Solvers/SolverChoice.h"

#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double Tolerance = 1e-8;
const std::string Names[] = { "Automatic", "Direct", "ConjugateGradient", "Multigrid" };

Vector Read(const std::string& path, Index count)
{
  Vector values(count);
  std::ifstream file(path, std::ios::binary);
  file.read(
    reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(sizeof(double)) * count);
  if (!file)
  {
    throw std::runtime_error("cannot read " + path);
  }
  return values;
}

void Write(const std::string& path, const Values& values)
{
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
    static_cast<std::streamsize>(sizeof(double)) * values.size());
  if (!file)
  {
    throw std::runtime_error("cannot write " + path);
  }
}

/// The value of a line of /proc/self/status in MiB; 0 if there is no such line.
double Memory(const std::string& key)
{
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
  {
    if (line.compare(0, key.size(), key) == 0)
    {
      return std::stod(line.substr(key.size() + 1)) / 1024.0;
    }
  }
  return 0.0;
}

SolverMethod MethodOf(const std::string& name, const SolverTask& task)
{
  for (int m = 0; m < 4; ++m)
  {
    if (name == Names[m])
    {
      return ChooseSolver(static_cast<SolverMethod>(m), task).Method;
    }
  }
  throw std::runtime_error("unknown solver " + name);
}

void Run(std::map<std::string, std::string> options)
{
  if (options["--task"] != "heat")
  {
    throw std::runtime_error("the task must be heat");
  }
  const Surface s = ReadOff(options["--mesh"]);
  const Vector start = Read(options["--u0"], s.NumberOfVertices());
  const double time = std::stod(options["--t"]);
  std::ofstream("/proc/self/clear_refs") << 5; // resets the peak
  const double memory = Memory("VmRSS");

  double before = Now();
  HeatSystem system(s);
  const TriangleMesh& mesh = *system.Mesh;
  const double h = mesh.LengthUnit() * mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  system.SetDiffusionNumber(time / (h * h));
  const double assembly = Now() - before;

  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.DiffusionNumber = time / (h * h);
  task.Tolerance = Tolerance;
  const std::string wish = options.count("--solver") ? options["--solver"] : "Automatic";
  const SolverMethod method = MethodOf(wish, task);
  const auto solver = MakeSolver(method);
  solver->SetLimits({ Tolerance, 100000 });
  before = Now();
  solver->SetMatrix(system.Matrix);
  const double setup = Now() - before;

  before = Now();
  Values u = GatherVertices(mesh, start);
  const Values b = system.RightHandSide(u);
  solver->Solve(b, u);
  const double solve = Now() - before;
  const double peak = Memory("VmHWM") - memory;

  Write(options["--out"], ToInput(mesh, u, s.NumberOfVertices()));
  std::printf("{\"assembly_s\": %.6g, \"setup_s\": %.6g, \"solve_s\": %.6g, \"peak_mib\": %.4g, "
              "\"version\": \"%s\"}\n",
    assembly, setup, solve, peak, Names[static_cast<int>(method)].c_str());
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    std::map<std::string, std::string> options;
    for (int i = 1; i + 1 < argc; i += 2)
    {
      options[argv[i]] = argv[i + 1];
    }
    Run(options);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "HeatStep: %s\n", error.what());
    return 1;
  }
  return 0;
}
