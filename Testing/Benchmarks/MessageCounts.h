// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace SurfaceDiffusion
{

/// The messages and bytes that this process has sent so far. MessageCounts.cxx counts them through
/// the profiling interface of MPI: it defines MPI_Send and the others, which call PMPI_Send.
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
