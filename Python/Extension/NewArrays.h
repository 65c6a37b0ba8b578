// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// An array of numpy that owns the numbers of a vector, which are not copied. shape: of its size.
template <typename T>
nanobind::object NewArray(std::vector<T>&& numbers, std::vector<std::size_t> shape)
{
  auto owned = std::make_unique<std::vector<T>>(std::move(numbers));
  T* const data = owned->data();
  const nanobind::capsule owner(
    owned.get(), [](void* pointer) noexcept { delete static_cast<std::vector<T>*>(pointer); });
  owned.release();
  return nanobind::cast(
    nanobind::ndarray<nanobind::numpy, T>(data, shape.size(), shape.data(), owner));
}

template <typename T>
nanobind::object NewArray(std::vector<T>&& numbers)
{
  const std::size_t size = numbers.size();
  return NewArray(std::move(numbers), { size });
}

} // namespace SurfaceDiffusion
