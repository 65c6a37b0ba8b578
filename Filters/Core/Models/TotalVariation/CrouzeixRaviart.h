// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"
#include "Core/Surface/MedialMesh.h"

#include <functional>
#include <memory>

namespace SurfaceDiffusion
{

/// Values at edges from values at vertices: their means, except at clear jumps. There the means
/// would form a band of intermediate values, which biases the perimeter of the jump; so an edge
/// takes the value of the end on whose side of the jump its midpoint lies, according to the data
/// smoothed over two to three rings; sum A w is that of the means as nearly as whole edges allow.
/// An edge is at a jump if its difference is 3.5 times the mean difference
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
/// corner values overshoot next to jumps. The error in sum A u of the limits is spread over a few
/// neighbours. So is the residue, which the start loses at jumps on its way to the edges and back;
/// it belongs to the jumps of the start and falls with them, in proportion to the range of w around
/// each vertex. The part of the total that it leaves behind is spread evenly over the connected
/// component, so that the total is conserved to round-off and flat states are flat.
class CrouzeixRaviartModel : public Model
{
public:
  using ModelMaker = std::function<std::unique_ptr<Model>(PointData edges)>;

  /// conserved: the components whose total the model conserves.
  CrouzeixRaviartModel(std::shared_ptr<const Assembler> vertices,
    std::shared_ptr<const MedialMesh> edges, PointData data, TotalCorrection conserved,
    const ModelMaker& makeModel, const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;
  double Energy() const override { return 4.0 * this->EdgeModel->Energy(); }

  /// Triangles of both meshes have the same numbers and, being similar, the same weights.
  DiffusionStep Diffusion() const override { return this->EdgeModel->Diffusion(); }
  const CornerWeights& DiffusionWeights(Eigen::Index column) override
  {
    return this->EdgeModel->DiffusionWeights(column);
  }

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
  Values StartRange; ///< of the edges around each vertex
  TotalCorrection Conserved;
  bool Started = false;
  Values U, Residue, TriangleMeans;
};

} // namespace SurfaceDiffusion
