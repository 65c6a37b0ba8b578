// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRunAlgorithm
 * @brief   superclass of the filters that compute each surface in one run, without time steps
 *
 * A subclass passes its settings and its class of runs (Filters/Run), and overrides FindFields(),
 * which finds the input arrays of a block. This class checks the settings, alone and together with
 * the arrays, updates the run of each surface, and adds its results to the output. A run is kept
 * until its surface, its arrays or the settings change.
 *
 * Each block of composite data is a surface of its own. An array that a block does not have, or
 * that is not numeric there, counts as not set there, with a warning, if at least one block has it,
 * and is an error otherwise.
 * Surfaces in pieces, over processes and partitions, are gathered and solved in process 0; see
 * vtkSurfaceFilter. The time of the input passes through.
 *
 * @sa vtkSurfaceFilter vtkSurfaceModelAlgorithm vtkSurfaceCurvatureFilter
 */
#ifndef vtkSurfaceRunAlgorithm_h
#define vtkSurfaceRunAlgorithm_h

#include "vtkSurfaceFilter.h"

namespace SurfaceDiffusion
{
struct InputFields;
class SurfaceRuns;
}

VTK_ABI_NAMESPACE_BEGIN
class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceRunAlgorithm : public vtkSurfaceFilter
{
public:
  vtkTypeMacro(vtkSurfaceRunAlgorithm, vtkSurfaceFilter);

  void ReleaseCache() override;

protected:
  /// settings: of the properties of the class. runs: of the class of runs that has these settings.
  /// resultArrayName: the default of ResultArrayName; if there is one, the name must not be empty.
  vtkSurfaceRunAlgorithm(SurfaceDiffusion::OwnedSettings settings,
    SurfaceDiffusion::SurfaceRuns runs, const char* resultArrayName = "");
  ~vtkSurfaceRunAlgorithm() override;

  /// Find and check the arrays of a block. False: the block has no data and passes through.
  virtual bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) = 0;

  /// Called after the runs of all surfaces have been updated, before their results are added to the
  /// outputs. Errors are std::runtime_error. The default does nothing.
  virtual void PrepareOutputs(
    const std::vector<SurfaceBlock>& surfaces, const SurfaceDiffusion::SurfaceRuns& runs);

  void ProcessSurfaces(const std::vector<SurfaceBlock>& blocks,
    const SurfaceDiffusion::ProgressMonitor& progress) override;

private:
  vtkSurfaceRunAlgorithm(const vtkSurfaceRunAlgorithm&) = delete;
  void operator=(const vtkSurfaceRunAlgorithm&) = delete;

  /// The runs, kept between updates.
  struct UpdateState;
  const std::unique_ptr<UpdateState> State;

  void FindAllFields(const std::vector<SurfaceBlock>& blocks, std::vector<SurfaceBlock>& surfaces,
    std::vector<SurfaceDiffusion::InputFields>& fields, Problems& problems);
};
VTK_ABI_NAMESPACE_END

#endif
