// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace SurfaceDiffusion
{

constexpr const char* OutOfMemoryMessage = "not enough memory";

/// The message of the process of lowest rank that has one; empty if none has. Collective.
std::string FirstMessage(const Reduction& processes, const std::string& here);

/// Do work that calls no other process. If it throws in one process, it throws in all of them.
/// Collective.
template <typename Work>
void RunCollectively(const Reduction& processes, const Work& work)
{
  if (processes.IsSerial())
  {
    work();
    return;
  }
  std::string failure;
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    failure = OutOfMemoryMessage;
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  failure = FirstMessage(processes, failure);
  if (!failure.empty())
  {
    throw std::runtime_error(failure);
  }
}

} // namespace SurfaceDiffusion
