// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/Derivatives.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

namespace SurfaceDiffusion
{

/// The derivatives of data on a surface.
enum class DerivativeQuantity
{
  Gradient, ///< of scalars
  Divergence, ///< of vectors
  Curl, ///< of vectors: the normal component
  Laplacian, ///< of scalars
  ConductionVelocity, ///< of times: grad T/|grad T|^2
  Helmholtz ///< the parts of vectors, see HelmholtzParts
};

/// Derivatives in the user's terms.
struct DerivativesSettings : Settings
{
  DerivativeQuantity Quantity = DerivativeQuantity::Gradient;
  double SmoothingFWHM = 0.0;
  bool ResultOnCells = false;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
  void Check(const FieldSummary* fields, Problems& problems) override;

  bool TakesVectors() const
  {
    return this->Quantity == DerivativeQuantity::Divergence ||
      this->Quantity == DerivativeQuantity::Curl || this->Quantity == DerivativeQuantity::Helmholtz;
  }
};

/// The derivatives of data on one surface, kept as long as neither inputs nor settings change.
class DerivativesRun : public SurfaceRun
{
public:
  explicit DerivativesRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "have no derivatives", " and are not their neighbours")
  {
  }

  /// Only Data and SlopeErrors of the fields are read.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;
  bool ExcludesMasked() const override { return true; }

private:
  /// About turned triangles, and about solves that missed their tolerance.
  std::vector<Warning> FindOwnWarnings() const override;
  /// The surface without the triangles whose data are missing.
  BlockInput WithoutMissing(const BlockInput& input);
  /// The data at the vertices, smoothed if the settings say so.
  Values ReadAtVertices(const Fields& fields, const Derivatives& operators, const Points& positions,
    double fwhm, const ProgressMonitor& progress);
  void AddResult(const char* name, Values ofVertices, const DerivativesSettings& settings);
  void AddParts(const Derivatives& operators, const Values& ofTriangles,
    const DerivativesSettings& settings, const ProgressMonitor& progress);
  void AddVelocity(Values gradients, const Values& turns, bool onTriangles);
  /// SpeedLower and SpeedUpper of speeds at points, from the errors of slopes there.
  void AddBand(const Values& speeds, const Values& slopeErrors);
  /// The divergence of the directions of the gradients of times on triangles, times the root of the control
  /// area: large where fronts begin, and far below 0 where they meet. On triangles the largest of the corners.
  Values FindTurns(const Derivatives& operators, const Values& gradients, bool onTriangles) const;
  void Add(const char* name, Values rows, bool onTriangles);

  Fingerprint MissingVersion; ///< of the data that MissingRows belong to
  bool IsMissingKnown = false;
  std::vector<char> MissingRows; ///< per point or cell: not finite; empty if none is
  bool MissingOnCells = false;
  Sentence OfTurns; ///< a warning of speeds that are not determined; otherwise empty
  Sentence NothingKnown; ///< the warning that no triangle has data; otherwise empty
  Index Turned = 0;
  Index Undetermined = 0; ///< vertices whose Laplacian is NaN
  double MissedResidual = 0.0;
};

} // namespace SurfaceDiffusion
