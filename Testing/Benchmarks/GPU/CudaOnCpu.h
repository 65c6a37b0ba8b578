// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdlib>
#include <cstring>

/// What Kernels.cu uses of CUDA, on one thread of the CPU: its kernels, whose loops run over any
/// number of threads, are then checked without a card. A grid has one block of one thread.

#define __global__
#define __device__
#define __forceinline__ inline
#define __shared__ static
#define __launch_bounds__(...)

struct Dimensions
{
  unsigned x;
};
constexpr Dimensions threadIdx{ 0 }, blockIdx{ 0 }, blockDim{ 1 }, gridDim{ 1 };

struct alignas(16) float4
{
  float x, y, z, w;
};

inline void __syncthreads() {}

template <typename T>
T __shfl_down_sync(unsigned, T, int)
{
  return T();
}

template <typename T>
T __ldg(const T* number)
{
  return *number;
}

template <typename T>
T __ldcg(const T* number)
{
  return *number;
}

using cudaError_t = int;
constexpr cudaError_t cudaSuccess = 0;
inline const char* cudaGetErrorString(cudaError_t)
{
  return "out of memory";
}
inline cudaError_t cudaGetLastError()
{
  return cudaSuccess;
}
inline cudaError_t cudaDeviceSynchronize()
{
  return cudaSuccess;
}

inline cudaError_t cudaMalloc(void** data, std::size_t bytes)
{
  *data = std::malloc(bytes);
  return *data ? cudaSuccess : 2;
}
inline cudaError_t cudaFree(void* data)
{
  std::free(data);
  return cudaSuccess;
}
inline cudaError_t cudaMallocHost(void** data, std::size_t bytes)
{
  return cudaMalloc(data, bytes);
}
inline cudaError_t cudaFreeHost(void* data)
{
  return cudaFree(data);
}
enum cudaMemcpyKind
{
  cudaMemcpyHostToDevice,
  cudaMemcpyDeviceToHost,
  cudaMemcpyDeviceToDevice
};
inline cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind)
{
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}
inline cudaError_t cudaMemset(void* data, int value, std::size_t bytes)
{
  std::memset(data, value, bytes);
  return cudaSuccess;
}

using cudaEvent_t = std::chrono::steady_clock::time_point;
inline cudaError_t cudaEventCreate(cudaEvent_t*)
{
  return cudaSuccess;
}
inline cudaError_t cudaEventDestroy(cudaEvent_t)
{
  return cudaSuccess;
}
inline cudaError_t cudaEventRecord(cudaEvent_t& event)
{
  event = std::chrono::steady_clock::now();
  return cudaSuccess;
}
inline cudaError_t cudaEventSynchronize(cudaEvent_t)
{
  return cudaSuccess;
}
inline cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t begin, cudaEvent_t end)
{
  *milliseconds = std::chrono::duration<float, std::milli>(end - begin).count();
  return cudaSuccess;
}
