// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace SurfaceDiffusion
{

/// A number of objects that are not initialised: unlike those of a std::vector, whose constructor
/// runs on one thread, their memory is touched first by the loops that fill them.
template <typename T>
class Buffer
{
  static_assert(std::is_trivial<T>::value, "the objects need no constructor");

public:
  Buffer() = default;
  explicit Buffer(std::size_t size)
    : Objects(new T[size])
    , Count(size)
  {
  }
  ~Buffer() = default;
  Buffer(const Buffer& other)
    : Buffer(other.Count)
  {
    std::copy(other.begin(), other.end(), this->begin());
  }
  Buffer(Buffer&& other) noexcept { this->swap(other); }
  Buffer& operator=(Buffer other) noexcept
  {
    this->swap(other);
    return *this;
  }

  void swap(Buffer& other) noexcept
  {
    std::swap(this->Objects, other.Objects);
    std::swap(this->Count, other.Count);
  }

  std::size_t size() const { return this->Count; }
  T* data() { return this->Objects.get(); }
  const T* data() const { return this->Objects.get(); }
  T* begin() { return this->data(); }
  const T* begin() const { return this->data(); }
  T* end() { return this->data() + this->Count; }
  const T* end() const { return this->data() + this->Count; }
  T& operator[](std::size_t i) { return this->Objects[i]; }
  const T& operator[](std::size_t i) const { return this->Objects[i]; }

private:
  std::unique_ptr<T[]> Objects;
  std::size_t Count = 0;
};

} // namespace SurfaceDiffusion
