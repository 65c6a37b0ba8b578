// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"

#include <cstddef>
#include <cstdint>

namespace SurfaceDiffusion
{

/// A 64-bit hash of contents. Inputs with equal fingerprints count as unchanged, regardless of
/// their addresses and modification times.
class Fingerprint
{
public:
  /// Add `size` bytes. The result does not depend on the number of threads.
  void AddBytes(const void* bytes, std::size_t size, const ParallelFor& parallel = SerialFor());
  void AddNumber(std::uint64_t number);
  void AddNumber(double number);
  void Add(const Fingerprint& other) { this->AddNumber(other.Hash); }

  friend bool operator==(const Fingerprint& a, const Fingerprint& b) { return a.Hash == b.Hash; }
  friend bool operator!=(const Fingerprint& a, const Fingerprint& b) { return !(a == b); }

private:
  std::uint64_t Hash = 0;
};

} // namespace SurfaceDiffusion
