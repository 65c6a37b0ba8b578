// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Output.h"
#include "Run/Run.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A computation on one surface without time steps. The surface and the result are kept as long as
/// neither the inputs nor the settings that they depend on change.
class SurfaceRun
{
public:
  virtual ~SurfaceRun() = default;

  /// Compute the result unless it is kept. given: settings that have passed Check(), of the class
  /// that belongs to that of the run, as CurvatureSettings to CurvatureRun. Throws
  /// std::runtime_error, std::bad_alloc, Aborted.
  virtual void Update(
    const BlockInput& input, Settings& given, const ProgressMonitor& progress) = 0;

  /// Whether triangles that the mask marks take no part.
  virtual bool ExcludesMasked() const { return false; }

  const Surface& GetSurface() const { return *this->Domain; }
  /// The surface that the result belongs to.
  const Fingerprint& GetSurfaceVersion() const { return this->SurfaceVersion; }
  /// What the computation returns.
  const std::vector<Output>& Outputs() const { return this->Results; }
  /// Of triangles of positive area, in coordinate units; 1 if there are none.
  double MeanEdgeLength() const;
  /// The warnings that hold.
  std::vector<Warning> FindWarnings() const { return FindAllWarnings({ this }, { "" }); }
  /// The warnings about the surfaces of several runs, each with the name of its block. All
  /// triangles of zero area are counted together, and so are coincident points.
  static std::vector<Warning> FindAllWarnings(
    const std::vector<const SurfaceRun*>& runs, const std::vector<std::string>& blocks);
  /// The numbers of several runs, each as a matrix, with the MeanEdgeLength of all.
  static std::map<std::string, Values> FindAllNumbers(const std::vector<const SurfaceRun*>& runs);

protected:
  /// ofDegenerate: what becomes of triangles of zero area, such as "have no normal". ofCoincident:
  /// what follows if points of the boundary coincide with others, which they are not merged with,
  /// such as " and may come apart"; null: there is no warning.
  SurfaceRun(const ParallelFor& parallel, const char* ofDegenerate, const char* ofCoincident)
    : Parallel(parallel)
    , OfDegenerate(ofDegenerate)
    , OfCoincident(ofCoincident)
  {
  }

  /// Those that are not about triangles of zero area or coincident points.
  virtual std::vector<Warning> FindOwnWarnings() const = 0;

  /// Make the surface unless it is kept. Returns whether the result has to be computed.
  bool Prepare(const BlockInput& input, Settings& settings, const SurfaceOptions& options,
    const ProgressMonitor& progress);
  /// The fields, of which FindAllWarnings() asks for sentinels; see AskForSentinels().
  Fields ReadFields(const BlockInput& input, const Sentence& aboutData = {});
  /// The result of this input and these settings has been computed.
  void Complete(const BlockInput& input, Settings& settings);

  /// The same input, whose control cells have the areas of the drawn surface.
  static BlockInput WithoutGivenAreas(const BlockInput& input);
  ///@{
  /// Append a warning unless the number is 0.
  void AppendTurnedTriangles(Index count, std::vector<Warning>& warnings) const;
  void AppendMissedResidual(double residual, std::vector<Warning>& warnings) const;
  /// Of a result that depends on the mean edge length: the edges that are left out of it.
  void AppendLongEdges(std::vector<Warning>& warnings) const;
  ///@}

  const ParallelFor& Parallel;
  Fingerprint SurfaceVersion, FieldsVersion;
  std::unique_ptr<Surface> Domain;
  std::vector<Output> Results;

private:
  const char* OfDegenerate;
  const char* OfCoincident;
  SettingsSnapshot SurfaceSettings, ModelSettings;
  std::vector<Sentence> Sentinels; ///< warnings of the fields
  bool HasResult = false;
};

} // namespace SurfaceDiffusion
