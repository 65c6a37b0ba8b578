// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The error of the steady state at the fidelity weight that is found, over that at the best weight, for
// kinds of noise, signals and surfaces, with data on points and on cells; and the time of the search in
// solves at a given weight. For the fields of one table: CompareWeights; times: CompareWeights time.
#include "CellRun.h"
#include "Heat.h"
#include "KindsOfNoise.h"

#include "Run/HeatSettings.h"
#include "Run/TotalVariationSettings.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using Testing::CellInput;
using Testing::NoiseKind;

namespace
{

double SignalAt(int signal, const Eigen::RowVector3d& x)
{
  switch (signal)
  {
    case 0: // smooth
      return 0.5 * std::sin(2.0 * x[0]) * std::cos(x[1]);
    case 1: // a cap
      return x[2] > 0.3 ? 0.5 : -0.5;
    case 2: // a ramp between plateaus
      return std::clamp(0.8 * x[0], -0.5, 0.5);
    default: // fine
      return 0.5 * std::sin(9.0 * x[0]) * std::cos(7.0 * x[1]);
  }
}

/// Root mean square of the state, over the area, from the signal. weight: that of the run.
template <typename ModelSettings>
double ErrorOf(
  const CellInput& input, const Vector& clean, const ModelSettings& settings, double* weight)
{
  Run run(SerialFor());
  const Values u = Testing::StateOf(run, { input.Block() }, settings);
  if (weight)
  {
    *weight = FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
  }
  const TriangleMesh& mesh = run.GetBlock(0).Surface->Mesh();
  double sum = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    sum += mesh.ControlAreas()[i] * std::pow(u(i, 0) - clean[mesh.InputVertex()[i]], 2);
  }
  return std::sqrt(sum / mesh.ControlAreas().sum());
}

/// The error over the best.
template <typename ModelSettings>
double RatioOf(const CellInput& input, const Vector& clean, ModelSettings settings)
{
  settings.AutomaticFidelity = true;
  double found = 0.0;
  const double error = ErrorOf(input, clean, settings, &found);
  settings.AutomaticFidelity = false;
  double best = error;
  for (int k = -10; k <= 10; ++k)
  {
    settings.FidelityWeight = found * std::exp2(0.6 * k);
    best = std::min(best, ErrorOf(input, clean, settings, nullptr));
  }
  return error / best;
}

void PrintRow(const char* name, std::vector<double> ratios)
{
  std::sort(ratios.begin(), ratios.end());
  std::printf("| %-16s | %4zu | %6.3f | %6.3f | %6.3f |\n", name, ratios.size(),
    ratios[ratios.size() / 2], ratios[ratios.size() * 9 / 10], ratios.back());
}

template <typename ModelSettings, typename ModeType>
void PrintTable(const char* title, ModeType steady, bool onCells)
{
  Testing::Surface square =
    Testing::Jittered(Testing::Strip(45, 45), 0.35 / 45.0, 0.001, 0.999, 0.001, 0.999);
  square.Vertices = 2.0 * (square.Vertices.array() - 0.5); // z is -1: the cap is constant there
  const std::vector<Testing::Surface> surfaces = { Testing::Icosphere(4), square,
    Testing::Torus(60, 30), Testing::Icosphere(2) };
  ModelSettings settings;
  settings.Mode = steady;
  std::printf("\n%s, data on %s\n| noise            | fields | median | of 90 %% | largest |\n",
    title, onCells ? "cells" : "points");
  std::vector<double> all;
  for (int kind = 0; kind < 9; ++kind)
  {
    std::vector<double> ratios;
    for (const Testing::Surface& surface : surfaces)
    {
      for (int signal = 0; signal < 4; ++signal)
      {
        for (const double sigma : { 0.05, 0.2 })
        {
          CellInput input(surface);
          Vector clean(surface.Vertices.rows());
          Values noisy(clean.size(), 1);
          const auto noise = [&](Index i, const Eigen::RowVector3d& x) {
            return Testing::WithNoise(static_cast<NoiseKind>(kind), SignalAt(signal, x), sigma, i);
          };
          for (Index i = 0; i < static_cast<Index>(clean.size()); ++i)
          {
            clean[i] = SignalAt(signal, surface.Vertices.row(i));
            noisy(i, 0) = noise(i, surface.Vertices.row(i));
          }
          input.SetData(noise);
          if (!onCells)
          {
            input.Data.Data.OnCells = false;
            input.Data.Data.Values = noisy;
          }
          ratios.push_back(RatioOf(input, clean, settings));
        }
      }
    }
    all.insert(all.end(), ratios.begin(), ratios.end());
    PrintRow(Testing::NamesOfNoise[kind], std::move(ratios));
    std::fflush(stdout);
  }
  PrintRow("all", std::move(all));
}

template <typename ModelSettings, typename ModeType>
void PrintTimes(const char* title, ModeType steady)
{
  for (const int level : { 5, 6, 7 })
  {
    const Testing::Surface s = Testing::Icosphere(level);
    CellInput input(s);
    input.Data.Data.OnCells = false;
    input.Data.Data.Values.resize(s.Vertices.rows(), 1);
    for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
    {
      input.Data.Data.Values(i, 0) =
        Testing::WithNoise(NoiseKind::Gaussian, SignalAt(2, s.Vertices.row(i)), 0.2, i);
    }
    ModelSettings settings;
    settings.Mode = steady;
    settings.AutomaticFidelity = true;
    double seconds[2] = {};
    for (double& time : seconds)
    {
      Run run(SerialFor());
      const auto start = std::chrono::steady_clock::now();
      Testing::StateOf(run, { input.Block() }, settings);
      time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      settings.FidelityWeight = FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
      settings.AutomaticFidelity = false;
    }
    std::printf("%s, %lld points: %.2f s with the search, %.2f s without: %.1f times\n", title,
      static_cast<long long>(s.Vertices.rows()), seconds[0], seconds[1], seconds[0] / seconds[1]);
  }
}

} // namespace

int main(int argc, char** /*argv*/)
{
  if (argc > 1)
  {
    PrintTimes<HeatSettings>("heat", HeatMode::SteadyState);
    PrintTimes<TotalVariationSettings>("total variation", TotalVariationMode::SteadyState);
    return 0;
  }
  for (const bool onCells : { false, true })
  {
    PrintTable<HeatSettings>("heat", HeatMode::SteadyState, onCells);
    PrintTable<TotalVariationSettings>("total variation", TotalVariationMode::SteadyState, onCells);
  }
  return 0;
}
