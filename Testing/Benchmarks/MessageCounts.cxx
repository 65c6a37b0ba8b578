// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCounts.h"

#include <mpi.h>

namespace SurfaceDiffusion
{

namespace
{

MessageCounts Counts;

double BytesOf(int count, MPI_Datatype type)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<double>(count) * size;
}

void CountMessage(int count, MPI_Datatype type)
{
  Counts.Messages += 1.0;
  Counts.Bytes += BytesOf(count, type);
}

void CountCollective(int count, MPI_Datatype type)
{
  Counts.Collectives += 1.0;
  Counts.CollectiveBytes += BytesOf(count, type);
}

} // namespace

const MessageCounts& MessageCounts::OfThisProcess()
{
  return Counts;
}

extern "C"
{

  int MPI_Send(
    const void* data, int count, MPI_Datatype type, int other, int tag, MPI_Comm communicator)
  {
    CountMessage(count, type);
    return PMPI_Send(data, count, type, other, tag, communicator);
  }

  int MPI_Ssend(
    const void* data, int count, MPI_Datatype type, int other, int tag, MPI_Comm communicator)
  {
    CountMessage(count, type);
    return PMPI_Ssend(data, count, type, other, tag, communicator);
  }

  int MPI_Isend(const void* data, int count, MPI_Datatype type, int other, int tag,
    MPI_Comm communicator, MPI_Request* request)
  {
    CountMessage(count, type);
    return PMPI_Isend(data, count, type, other, tag, communicator, request);
  }

  int MPI_Allreduce(const void* here, void* all, int count, MPI_Datatype type, MPI_Op operation,
    MPI_Comm communicator)
  {
    CountCollective(count, type);
    return PMPI_Allreduce(here, all, count, type, operation, communicator);
  }

  int MPI_Allgather(const void* here, int count, MPI_Datatype type, void* all, int countOfEach,
    MPI_Datatype typeOfAll, MPI_Comm communicator)
  {
    CountCollective(count, type);
    return PMPI_Allgather(here, count, type, all, countOfEach, typeOfAll, communicator);
  }

  int MPI_Allgatherv(const void* here, int count, MPI_Datatype type, void* all, const int* counts,
    const int* offsets, MPI_Datatype typeOfAll, MPI_Comm communicator)
  {
    CountCollective(count, type);
    return PMPI_Allgatherv(here, count, type, all, counts, offsets, typeOfAll, communicator);
  }

  int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm communicator)
  {
    CountCollective(count, type);
    return PMPI_Bcast(data, count, type, root, communicator);
  }

  int MPI_Barrier(MPI_Comm communicator)
  {
    Counts.Barriers += 1.0;
    return PMPI_Barrier(communicator);
  }

} // extern "C"

} // namespace SurfaceDiffusion
