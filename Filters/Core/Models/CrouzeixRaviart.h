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
/// would form a band of intermediate values, which biases the perimeter of the jump; so an edge
/// takes the value of the end on whose side of the jump its midpoint lies, according to the data
/// smoothed over one ring. An edge is at a jump if its difference is 3.5 times the mean difference
/// around it (4 to 5 times at a straight jump between smooth parts, seldom in noise); from 2.5
/// times on, the value of the end starts to count.
Values EdgesFromVertices(const Assembler& vertices, const MedialMesh& edges, const Values& u,
  const ParallelFor& parallel = SerialFor());

/// Values at vertices from values at edges: the means over the control cells of the values of the
/// Crouzeix-Raviart functions in the corners, w_ij + w_ik - w_jk at v_i. Conserves sum A u and is
/// exact for means of vertex values.
void VerticesFromEdges(const TriangleMesh& vertices, const MedialMesh& edges, const Values& w,
  Values& u, const ParallelFor& parallel = SerialFor());

/// A model in nonconforming Crouzeix-Raviart elements: runs it on the medial mesh, from and to
/// values at the vertices. Fidelity acts on edges with two known ends; edges with two fixed ends
/// are fixed.
///
/// The state is v = VerticesFromEdges(w), limited by the edges around each vertex, since the
/// corner values overshoot next to jumps. The error in sum A u of the limits, and of the start on
/// its way to the edges and back, is spread over a few neighbours, so that the total is conserved
/// exactly and nothing of the finest scale of the start remains.
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

  std::shared_ptr<const Assembler> Assembly;
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
