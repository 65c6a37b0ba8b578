// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace SurfaceDiffusion
{

/// What this process has told MPI so far. The program that links MessageCounts.cxx has MPI's
/// functions replaced by ones that count and call the originals (the profiling interface of MPI).
struct MessageCounts
{
  double Messages = 0.0; ///< to one other process
  double Bytes = 0.0; ///< in these
  double Collectives = 0.0; ///< reductions, gathers and broadcasts over all processes
  double CollectiveBytes = 0.0; ///< that this process contributes to these
  double Barriers = 0.0;

  static const MessageCounts& OfThisProcess();
};

} // namespace SurfaceDiffusion
