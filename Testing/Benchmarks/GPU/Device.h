// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

/// A prototype of the solvers on a GPU, for measurements. No type of CUDA or Eigen is in this
/// header. Every call throws std::runtime_error if CUDA reports an error, and returns when the
/// device has finished.
namespace SurfaceDiffusion::Gpu
{

/// A sparse matrix by rows, in memory of the host.
struct HostRows
{
  int Count;
  const int* Outer; ///< the number of the first entry of each row, and their end
  const int* Inner; ///< the column of each entry
  const double* Values;
};

/// A level of Multigrid, but the coarsest one.
struct HostLevel
{
  HostRows A, Prolongation, Restriction; ///< A of the finest level: that of the solver is taken
  const double* InverseD; ///< 1 / sum_j |a_ij|
};

struct SolveResult
{
  int Iterations = 0;
  double Residual = 0.0; ///< see SolveReport
  bool Converged = false;
  double Milliseconds = 0.0; ///< on the device, without transfers
};

enum class SolveMethod
{
  Double, ///< conjugate gradients with Jacobi preconditioner in double precision
  Mixed, ///< in single precision, and residuals in double precision: SinglePrecisionSolver
  Multigrid ///< conjugate gradients in double precision with a cycle in single precision
};

/// Backward Euler steps A x = M u with a matrix that stays on the device.
class HeatSolver
{
public:
  /// masses: the diagonal of M; share: of its sum in the sum of the diagonal of the matrix.
  HeatSolver(const HostRows& matrix, const double* masses, double share);
  ~HeatSolver();

  /// coarsest: the inverse of the coarsest matrix, dense.
  void SetHierarchy(const std::vector<HostLevel>& levels, const std::vector<float>& coarsest);

  /// u: rows of 1 or 8 columns.
  void Upload(const double* u, int columns);
  SolveResult Solve(SolveMethod method, double tolerance, int maximumNumberOfIterations);
  void Download(double* x) const;

  /// The rows of the last Upload(), divided by the roots of the diagonal, by `count` cycles one
  /// after the other on the same right-hand side. Milliseconds: of one cycle.
  SolveResult Cycle(int count);

  /// Of single precision, with padding.
  double EntriesOfMatrix() const;
  double EntriesOfLevels() const;

private:
  struct Data;
  std::unique_ptr<Data> D;
};

/// The mesh of TriangleMesh.
struct HostMesh
{
  int Vertices, Triangles;
  const int* TriangleVertices; ///< 3 numbers per triangle
  const double* Shapes; ///< Length, X, Y, Weight per triangle
  const int* CornersBegin; ///< of VertexCorners(), per vertex
  const int* Corners;
  const int* Outer; ///< the pattern of the matrix
  const int* Inner;
};

/// TotalVariationMinimizer for total variation with quadratic fidelity at every vertex, in single
/// precision.
class Minimizer
{
public:
  /// quadraticAreas: mu_i A_i.
  Minimizer(const HostMesh& mesh, const double* quadraticAreas);
  ~Minimizer();

  struct Report
  {
    int Iterations = 0;
    double Gap = 0.0;
    double SweepMilliseconds = 0.0; ///< of all sweeps
    double Milliseconds = 0.0; ///< of all, without transfers of data
    bool NeedsDouble = false; ///< single precision does not reach the tolerance
    int InnerIterations = 0;
  };

  /// data: 1 or 3 columns, joint; the start. typicalRange: TypicalRange() of them.
  void Upload(const double* data, int columns);
  Report Minimize(double typicalRange, double stopTolerance, int maximumNumberOfIterations);
  void Download(double* u) const;

private:
  struct Data;
  std::unique_ptr<Data> D;
};

/// The name of the device, and seconds that the first call takes: the context.
std::string StartDevice(double& seconds);

/// GB/s: of copies on the device, bytes read and bytes written; to and from the device with memory
/// of the host that is pageable or pinned.
struct Bandwidth
{
  double OnDevice, PageableUp, PageableDown, PinnedUp, PinnedDown;
};
Bandwidth MeasureBandwidth(std::size_t bytes);

/// Memory of the host that copies need not pass through a buffer.
double* AllocatePinned(std::size_t count);
void FreePinned(double* numbers);

/// Microseconds of a barrier over the whole grid.
double MeasureBarrier();

} // namespace SurfaceDiffusion::Gpu
