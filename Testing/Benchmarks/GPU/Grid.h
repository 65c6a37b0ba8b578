// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Device.h"

#ifdef __CUDACC__
#include <cooperative_groups.h>
#else
#include "CudaOnCpu.h"
#endif

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

/// Loops, sums and sparse products over all threads of a kernel. A kernel is a whole solve: its
/// blocks are all on the device at once and meet at barriers, so that launches cost nothing. Sums
/// have one order, and so results the same bits in every run on a device of the same size.
namespace SurfaceDiffusion::Gpu
{

constexpr int Threads = 256; ///< of a block
constexpr int Lanes = 32; ///< of a slice
constexpr int MostBlocks = 8192;
constexpr int MostColumns = 8;
#ifdef __CUDACC__
constexpr int WarpWidth = 32;
#else
constexpr int WarpWidth = 1;
#endif

inline void Check(cudaError_t error, const char* what)
{
  if (error != cudaSuccess)
  {
    throw std::runtime_error(std::string(what) + ": " + cudaGetErrorString(error));
  }
}

// --- Memory ---

template <typename T>
class Array
{
public:
  Array() = default;
  explicit Array(std::size_t size)
    : Count(size)
  {
    void* data = nullptr;
    Check(cudaMalloc(&data, std::max<std::size_t>(1, size) * sizeof(T)), "memory of the device");
    this->Numbers = static_cast<T*>(data);
  }
  Array(const T* numbers, std::size_t size)
    : Array(size)
  {
    this->Take(numbers);
  }
  Array(Array&& other) noexcept { this->Swap(other); }
  Array& operator=(Array&& other) noexcept
  {
    this->Swap(other);
    return *this;
  }
  ~Array() { cudaFree(this->Numbers); }

  void Take(const T* numbers)
  {
    Check(cudaMemcpy(this->Numbers, numbers, this->Count * sizeof(T), cudaMemcpyHostToDevice),
      "copy to the device");
    Check(cudaDeviceSynchronize(), "copy to the device"); // copies of pageable memory return early
  }
  void Give(T* numbers, std::size_t count) const
  {
    Check(cudaMemcpy(numbers, this->Numbers, count * sizeof(T), cudaMemcpyDeviceToHost),
      "copy from the device");
  }
  T* Get() const { return this->Numbers; }
  std::size_t Size() const { return this->Count; }

private:
  void Swap(Array& other)
  {
    std::swap(this->Numbers, other.Numbers);
    std::swap(this->Count, other.Count);
  }

  T* Numbers = nullptr;
  std::size_t Count = 0;
};

// --- Time ---

class Timer
{
public:
  Timer()
  {
    Check(cudaEventCreate(&this->Begin), "event");
    Check(cudaEventCreate(&this->End), "event");
  }
  ~Timer()
  {
    cudaEventDestroy(this->Begin);
    cudaEventDestroy(this->End);
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void Start() { Check(cudaEventRecord(this->Begin), "event"); }
  double Milliseconds()
  {
    Check(cudaEventRecord(this->End), "event");
    Check(cudaEventSynchronize(this->End), "kernel");
    float milliseconds = 0.0F;
    Check(cudaEventElapsedTime(&milliseconds, this->Begin, this->End), "event");
    return milliseconds;
  }

private:
  cudaEvent_t Begin, End;
};

// --- Threads ---

__device__ inline int Thread()
{
  return static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
}

__device__ inline int NumberOfThreads()
{
  return static_cast<int>(gridDim.x * blockDim.x);
}

/// All writes before it are seen after it.
__device__ inline void MeetAll()
{
#ifdef __CUDACC__
  cooperative_groups::this_grid().sync();
#endif
}

template <typename Act>
__device__ void ForEach(int count, const Act& act)
{
  for (int i = Thread(); i < count; i += NumberOfThreads())
  {
    act(i);
  }
}

template <int K>
__device__ void SumOverWarp(double (&sums)[K])
{
  for (int offset = WarpWidth / 2; offset > 0; offset /= 2)
  {
    for (int k = 0; k < K; ++k)
    {
      sums[k] += __shfl_down_sync(0xffffffffU, sums[k], offset);
    }
  }
}

/// In the first thread of the block the sums over its threads.
template <int K>
__device__ void SumOverBlock(double (&sums)[K])
{
  __shared__ double parts[Threads / WarpWidth][K];
  const int warp = static_cast<int>(threadIdx.x) / WarpWidth;
  SumOverWarp(sums);
  __syncthreads(); // what an earlier sum left has been read
  if (threadIdx.x % WarpWidth == 0)
  {
    for (int k = 0; k < K; ++k)
    {
      parts[warp][k] = sums[k];
    }
  }
  __syncthreads();
  if (threadIdx.x == 0)
  {
    for (int w = 1; w < static_cast<int>(blockDim.x) / WarpWidth; ++w)
    {
      for (int k = 0; k < K; ++k)
      {
        sums[k] += parts[w][k];
      }
    }
  }
}

/// Sums over the grid, which all threads know afterwards. Each one is a barrier of the grid.
template <int K>
class GridSums
{
public:
  /// work: 2 MostBlocks K numbers; totals: K numbers in shared memory.
  __device__ GridSums(double* work, double* totals)
    : Work(work)
    , Totals(totals)
  {
  }

  __device__ void Take(double (&sums)[K])
  {
    // The other half is read by blocks that have not yet left the last sum.
    this->Half = 1 - this->Half;
    double* const partial = this->Work + this->Half * MostBlocks * K;
    SumOverBlock(sums);
    if (threadIdx.x == 0)
    {
      for (int k = 0; k < K; ++k)
      {
        partial[blockIdx.x * K + k] = sums[k];
      }
    }
    MeetAll();
    const int lane = static_cast<int>(threadIdx.x) % WarpWidth;
    const int warps = static_cast<int>(blockDim.x) / WarpWidth;
    for (int k = static_cast<int>(threadIdx.x) / WarpWidth; k < K; k += warps)
    {
      double total[1] = { 0.0 };
      for (int b = lane; b < static_cast<int>(gridDim.x); b += WarpWidth)
      {
        total[0] += __ldcg(partial + b * K + k);
      }
      SumOverWarp(total);
      if (lane == 0)
      {
        this->Totals[k] = total[0];
      }
    }
    __syncthreads();
  }

  __device__ double operator[](int k) const { return this->Totals[k]; }

private:
  double* Work;
  double* Totals;
  int Half = 0;
};

// --- Rows and matrices ---

/// The columns of a vertex, which are adjacent.
template <typename T, int K>
struct alignas(K * sizeof(T) % 16 == 0 ? 16 : sizeof(T)) Row
{
  T At[K];
};

/// Numbers, K per vertex, as rows.
template <typename T, int K>
__device__ Row<T, K>* Rows(T* numbers)
{
  return reinterpret_cast<Row<T, K>*>(numbers);
}

template <typename T, int K>
__device__ const Row<T, K>* Rows(const T* numbers)
{
  return reinterpret_cast<const Row<T, K>*>(numbers);
}

/// Slices of 32 rows are stored entry by entry (SlicedMatrix.h), so that the threads of a warp read
/// adjacent entries. Rows with more than LongestInSlice entries, as at the poles of spheres with
/// meridians, are stored apart, and each is the work of a block.
struct Slices
{
  static constexpr int LongestInSlice = 64;

  int Rows;
  bool HasUnitDiagonal; ///< which is not stored
  const int* Begin; ///< of the entries of each slice, and their end
  const int* Columns;
  float* Singles;
  double* Doubles; ///< or null
  int LongRows;
  const char* IsLong; ///< per row
  const int* LongRow;
  const int* LongBegin;
  const int* LongColumns;
  float* LongSingles;
  double* LongDoubles;

  __device__ const float* Entries(float) const { return this->Singles; }
  __device__ const double* Entries(double) const { return this->Doubles; }
  __device__ const float* LongEntries(float) const { return this->LongSingles; }
  __device__ const double* LongEntries(double) const { return this->LongDoubles; }
};

/// use(i, products) with the product of row i and x, for all rows.
template <typename T, int K, typename Use>
__device__ void ForRows(const Slices& m, const Row<T, K>* x, const Use& use)
{
  constexpr int Batch = K == 1 ? 8 : K < 8 ? 4 : 2;
  const T* const entries = m.Entries(T());
  ForEach(m.Rows,
    [&](int i)
    {
      if (m.LongRows > 0 && m.IsLong[i])
      {
        return;
      }
      Row<T, K> products = {};
      if (m.HasUnitDiagonal)
      {
        products = x[i];
      }
      const int end = __ldg(m.Begin + i / Lanes + 1);
      for (int first = __ldg(m.Begin + i / Lanes) + i % Lanes; first < end; first += Batch * Lanes)
      {
        // All loads of a batch are on their way before the first one is used.
        int columns[Batch];
        T batch[Batch];
        Row<T, K> others[Batch];
#pragma unroll
        for (int b = 0; b < Batch; ++b)
        {
          const int at = first + b * Lanes;
          columns[b] = at < end ? __ldg(m.Columns + at) : -1;
          batch[b] = at < end ? __ldg(entries + at) : T(0);
        }
#pragma unroll
        for (int b = 0; b < Batch; ++b)
        {
          others[b] = columns[b] >= 0 ? x[columns[b]] : Row<T, K>{};
        }
#pragma unroll
        for (int b = 0; b < Batch; ++b)
        {
          for (int k = 0; k < K; ++k)
          {
            products.At[k] += batch[b] * others[b].At[k];
          }
        }
      }
      use(i, products);
    });
  const T* const longEntries = m.LongEntries(T());
  for (int l = static_cast<int>(blockIdx.x); l < m.LongRows; l += static_cast<int>(gridDim.x))
  {
    double sums[K] = {};
    const int end = m.LongBegin[l + 1];
    for (int at = m.LongBegin[l] + static_cast<int>(threadIdx.x); at < end;
         at += static_cast<int>(blockDim.x))
    {
      const T entry = longEntries[at];
      const Row<T, K> other = x[m.LongColumns[at]];
      for (int k = 0; k < K; ++k)
      {
        sums[k] += entry * other.At[k];
      }
    }
    SumOverBlock(sums);
    if (threadIdx.x == 0)
    {
      const int i = m.LongRow[l];
      Row<T, K> products = {};
      if (m.HasUnitDiagonal)
      {
        products = x[i];
      }
      for (int k = 0; k < K; ++k)
      {
        products.At[k] += static_cast<T>(sums[k]);
      }
      use(i, products);
    }
  }
}

/// The memory of Slices.
class DeviceRows
{
public:
  DeviceRows() = default;
  /// Without a diagonal that is to be 1: the matrix is then scaled from both sides by `roots`, the
  /// roots of its inverse diagonal, which this computes. hasDoubles: keep both precisions.
  DeviceRows(const HostRows& rows, bool hasUnitDiagonal, double* roots, bool hasDoubles);

  Slices View;
  double NumberOfEntries = 0.0; ///< with padding

private:
  Array<int> Begin, Columns, LongRow, LongBegin, LongColumns;
  Array<float> Singles, LongSingles;
  Array<double> Doubles, LongDoubles;
  Array<char> IsLong;
};

// --- Kernels ---

#ifdef __CUDACC__
/// As many blocks as are on the device at once.
template <typename Arguments>
int BlocksOf(void (*kernel)(Arguments))
{
  int device = 0;
  int processors = 0;
  int blocks = 0;
  Check(cudaGetDevice(&device), "device");
  Check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "device");
  Check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, Threads, 0), "occupancy");
  return std::min(MostBlocks, processors * blocks);
}
#endif

/// Starts a kernel on the whole device.
template <typename Arguments>
void Launch(void (*kernel)(Arguments), Arguments arguments)
{
#ifdef __CUDACC__
  void* list[] = { &arguments };
  Check(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(kernel), dim3(BlocksOf(kernel)),
          dim3(Threads), list, 0, nullptr),
    "launch");
#else
  kernel(arguments);
#endif
}

} // namespace SurfaceDiffusion::Gpu
