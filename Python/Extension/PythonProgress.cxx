// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PythonProgress.h"

#include <algorithm>
#include <utility>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

PythonProgress::PythonProgress(nb::object callable)
  : Callable(std::move(callable))
  , Last(std::chrono::steady_clock::now())
{
}

void PythonProgress::Run(const std::function<void(const ProgressMonitor&)>& work)
{
  const ProgressMonitor::Callback callback = [this](double fraction)
  { return this->Report(fraction); };
  const nb::gil_scoped_release released;
  LoopWatch watch([&] { return this->Report(this->Fraction); });
  try
  {
    WithValueErrors([&] { work(ProgressMonitor(callback)); });
  }
  catch (const Aborted&)
  {
    std::rethrow_exception(this->Failure);
  }
}

bool PythonProgress::Report(double fraction)
{
  if (std::this_thread::get_id() != this->Owner)
  {
    return !this->Stopped;
  }
  this->Fraction = std::max(this->Fraction, fraction);
  const auto now = std::chrono::steady_clock::now();
  if (!this->Stopped && now - this->Last >= std::chrono::milliseconds(50))
  {
    this->Ask();
    this->Last = std::chrono::steady_clock::now();
  }
  return !this->Stopped;
}

void PythonProgress::Ask()
{
  const nb::gil_scoped_acquire acquired;
  try
  {
    if (PyErr_CheckSignals() != 0)
    {
      throw nb::python_error();
    }
    if (!this->Callable.is_none())
    {
      this->Callable(this->Fraction);
    }
  }
  catch (...)
  {
    this->Failure = std::current_exception();
    this->Stopped = true;
  }
}

} // namespace SurfaceDiffusion
