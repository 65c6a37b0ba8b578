// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Fingerprint.h"

#include "Core/Foundation/Random.h"

#include <cstring>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr std::size_t ChunkSize = 1 << 16; ///< bytes hashed by one thread at a time

std::uint64_t LoadWord(const unsigned char* bytes, std::size_t size)
{
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, size);
  return word;
}

/// Four independent lanes keep the multipliers of the processor busy.
std::uint64_t HashChunk(const unsigned char* bytes, std::size_t size)
{
  constexpr std::size_t word = sizeof(std::uint64_t);
  std::uint64_t lanes[4] = { 1, 2, 3, 4 };
  std::size_t at = 0;
  for (; at + 4 * word <= size; at += 4 * word)
  {
    for (std::size_t lane = 0; lane < 4; ++lane)
    {
      lanes[lane] = MixBits(lanes[lane] ^ LoadWord(bytes + at + lane * word, word));
    }
  }
  std::uint64_t hash = MixBits(size);
  for (const std::uint64_t lane : lanes)
  {
    hash = MixBits(hash ^ lane);
  }
  for (; at < size; at += word)
  {
    hash = MixBits(hash ^ LoadWord(bytes + at, size - at < word ? size - at : word));
  }
  return hash;
}

} // namespace

void Fingerprint::AddNumber(std::uint64_t number)
{
  this->Hash = MixBits(MixBits(this->Hash) ^ number);
}

void Fingerprint::AddNumber(double number)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof(bits));
  this->AddNumber(bits);
}

void Fingerprint::AddBytes(const void* bytes, std::size_t size, const ParallelFor& parallel)
{
  const auto* first = static_cast<const unsigned char*>(bytes);
  std::vector<std::uint64_t> hashes((size + ChunkSize - 1) / ChunkSize);
  parallel.Run(static_cast<Index>(hashes.size()),
    [&](Index begin, Index end)
    {
      for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c)
      {
        const std::size_t at = c * ChunkSize;
        hashes[c] = HashChunk(first + at, size - at < ChunkSize ? size - at : ChunkSize);
      }
    });
  this->AddNumber(static_cast<std::uint64_t>(size));
  for (const std::uint64_t hash : hashes)
  {
    this->AddNumber(hash);
  }
}

} // namespace SurfaceDiffusion
