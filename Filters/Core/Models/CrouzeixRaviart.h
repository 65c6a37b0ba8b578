// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Surface/MedialMesh.h"

#include <functional>
#include <memory>

namespace SurfaceDiffusion
{

/// Values at edges from values at vertices: their means, except at clear jumps. There the means
/// would be a belt of half values, whose two rims have other lengths than the jump; so an edge
/// takes the value of the end on whose side its midpoint lies, judged by the data smoothed over
/// one ring. An edge jumps where its difference is 3.5 times the mean difference about it (4 to 5
/// times at a straight jump between smooth parts, seldom in noise); from 2.5 times on the end value
/// starts to count.
Values EdgesFromVertices(const Assembler& vertices, const MedialMesh& edges, const Values& u,
  const ParallelFor& parallel = SerialFor());

/// Values at vertices from values at edges: the means over the control cells of what the
/// Crouzeix-Raviart functions are in the corners, w_ij + w_ik - w_jk at v_i. Keeps sum A u and is
/// exact for means of vertex values.
void VerticesFromEdges(const TriangleMesh& vertices, const MedialMesh& edges, const Values& w,
  Values& u, const ParallelFor& parallel = SerialFor());

/// Runs a model on the medial mesh, on data that come and go at the vertices. Fidelity acts on
/// edges with two known ends; edges with two fixed ends are fixed.
///
/// The state is v = VerticesFromEdges(w), limited by the edges around each vertex, since the
/// corner values overshoot next to jumps. What limits and the start's own way to the edges and
/// back leave of sum A u is spread over a few neighbours, so that it is kept exactly and nothing
/// of the start's finest scale stays.
class CrouzeixRaviartModel : public Model
{
public:
  using ModelMaker = std::function<std::unique_ptr<Model>(PointData edges)>;

  CrouzeixRaviartModel(std::shared_ptr<const Assembler> vertices,
    std::shared_ptr<const MedialMesh> edges, PointData data, const ModelMaker& makeModel,
    const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;
  double Energy() const override { return 4.0 * this->EdgeModel->Energy(); }

  std::size_t CheckpointSize() const override { return this->EdgeModel->CheckpointSize() + 1; }
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  void UpdateState();

  std::shared_ptr<const Assembler> Operators;
  std::shared_ptr<const MedialMesh> Edges;
  Values Start;
  Flags Fixed;
  const ParallelFor& Parallel;
  std::unique_ptr<Model> EdgeModel;
  Values StartResidue; ///< of the start on the way to the edges and back
  bool Started = false;
  Values U, Residue, TriangleMeans;
};

} // namespace SurfaceDiffusion
