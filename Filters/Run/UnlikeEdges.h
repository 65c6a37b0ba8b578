// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"
#include "Run/ModelInputs.h"
#include "Run/Sentence.h"

namespace SurfaceDiffusion
{

/// What to say of lengths that are measured in h if the connected components of the surface have
/// mean edge lengths that differ by more than a factor of 5; otherwise empty. Components with less
/// than 1 % of the triangles do not count, nor pieces of a distributed surface.
Sentence SentenceOfUnlikeEdges(const TriangleMesh& mesh);

/// What to say of edges that are left out of h; see EdgeLengths.h. Empty without any.
Sentence SentenceOfLongEdges(double count);

inline void WarnOfUnlikeEdges(const TriangleMesh& mesh, RunResult& result)
{
  const Sentence text = SentenceOfUnlikeEdges(mesh);
  if (!text.Words().empty())
  {
    result.WarnOnce(text);
  }
}

} // namespace SurfaceDiffusion
