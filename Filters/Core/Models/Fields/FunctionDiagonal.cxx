// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/FunctionDiagonal.h"

#include "Core/Solvers/NestedDissection.h"
#include "Core/Solvers/SupernodalFactor.h"

#include <Eigen/Dense>

#include <cmath>

namespace SurfaceDiffusion
{

double WeightOfEigenvalue(double x)
{
  constexpr double atZero = 0.03; // the weight of small x, which are all there is if s is small
  return atZero + x;
}

PoleSum FitPoles(const std::function<double(double)>& g, double first, double last, int count,
  const std::function<double(double)>& weight, bool hasConstant)
{
  constexpr int samples = 2000;
  constexpr double smallest = 1e-4;
  constexpr double largest = 1e6;
  PoleSum sum;
  sum.Poles.resize(count);
  for (int j = 0; j < count; ++j)
  {
    sum.Poles[j] = first * std::pow(last / first, count > 1 ? j / (count - 1.0) : 0.0);
  }
  Eigen::MatrixXd terms(samples, count + (hasConstant ? 1 : 0));
  Vector wanted(samples);
  for (int i = 0; i < samples; ++i)
  {
    const double x = smallest * std::pow(largest / smallest, i / (samples - 1.0));
    const double w = weight(x);
    terms.row(i).head(count) = (w / (sum.Poles.array() + x)).transpose();
    terms.row(i).tail(terms.cols() - count).setConstant(w);
    wanted[i] = w * g(x);
  }
  const Vector sizes = terms.colwise().norm();
  terms.array().rowwise() /= sizes.transpose().array();
  const Vector found = terms.colPivHouseholderQr().solve(wanted).cwiseQuotient(sizes);
  sum.Residues = found.head(count);
  sum.Constant = hasConstant ? found[count] : 0.0;
  return sum;
}

int SharedPoles::NumberOf(double p) const
{
  return static_cast<int>(std::lround(std::log(p / this->First) / std::log(this->Ratio)));
}

double SharedPoles::Near(double p)
{
  this->First = this->First > 0.0 ? this->First : p;
  return this->First * std::pow(this->Ratio, this->NumberOf(p));
}

Vector FunctionDiagonal(const Assembler& assembler, const CornerWeights& coefficients, double s,
  const PoleSum& f, const Vector& extra, const ParallelFor& parallel,
  const ProgressMonitor& progress, SharedPoles* shared)
{
  const TriangleMesh& mesh = assembler.Mesh();
  Vector diagonal = Vector::Zero(mesh.NumberOfVertices());
  if (mesh.NumberOfVertices() == 0)
  {
    return diagonal;
  }
  SparseMatrix matrix = ZeroMatrix(assembler.Pattern());
  const bool isRegular = IsRegular(matrix);
  constexpr double resolved = 1e-14;
  SupernodalFactor factor;
  SharedPoles own;
  std::map<int, Vector>& known = (shared ? *shared : own).Diagonals;
  const auto count = static_cast<double>(f.Poles.size());
  for (Eigen::Index j = 0; j < f.Poles.size(); ++j)
  {
    const double done = static_cast<double>(j);
    Vector& inverse =
      known[shared ? shared->NumberOf(f.Poles[j] / s) : static_cast<int>(j)]; // over s
    if (inverse.size() == 0)
    {
      Vector masses = f.Poles[j] * mesh.ControlAreas();
      if (extra.size() > 0)
      {
        masses += extra.cwiseProduct(mesh.ControlAreas());
      }
      assembler.Fill(matrix, masses, s, coefficients, nullptr, parallel);
      factor.Compute(
        matrix, isRegular, resolved, parallel, progress.Part(done / count, (done + 0.5) / count));
      inverse = s *
        factor.InverseDiagonal(parallel, progress.Part((done + 0.5) / count, (done + 1.0) / count));
    }
    diagonal += f.Residues[j] / s * inverse;
    if (!shared)
    {
      known.clear();
    }
  }
  if (shared)
  {
    known.erase(known.upper_bound(shared->NumberOf(f.Poles[f.Poles.size() - 1] / s)), known.end());
  }
  return diagonal;
}

} // namespace SurfaceDiffusion
