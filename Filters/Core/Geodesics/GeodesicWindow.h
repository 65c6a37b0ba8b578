// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Straight ways that enter a triangle through an interval of an edge, laid out in the plane of the
/// triangle: the edge lies on the x-axis from 0 on, the triangle above it, and the place that the
/// ways come from below it or, at the ends of sources on the edge, on it. A strip is a window whose
/// ways are parallel, as those that leave a line at right angles.
struct GeodesicWindow
{
  double Begin, End; ///< of the interval
  double X, Y; ///< the place; of a strip, the unit vector against the ways. Y <= 0
  double Start; ///< the distance at the place; of a strip, at the origin
  double AtBegin, AtEnd; ///< the distances at the ends of the interval
  Index Source;
  bool IsStrip;
  bool IsPast; ///< it has gone over the triangle

  /// The distance at the place x of the edge.
  double At(double x) const
  {
    return this->IsStrip
      ? this->Start - this->X * x
      : this->Start + std::sqrt((x - this->X) * (x - this->X) + this->Y * this->Y);
  }
  /// The distance at a place (x, y) of the triangle by a way through the interval, y >= 0. Where no
  /// straight one leads there, it turns at an end of the interval.
  double Beyond(double x, double y) const
  {
    const double rise = y - this->Y;
    double crossing = x;
    if (this->IsStrip)
    {
      crossing = this->Y < 0.0 ? x - y * this->X / this->Y : x;
    }
    else if (rise > 0.0)
    {
      crossing = x - y * (x - this->X) / rise;
    }
    crossing = std::clamp(crossing, this->Begin, this->End);
    return this->At(crossing) + std::sqrt((x - crossing) * (x - crossing) + y * y);
  }
  /// The x-component of the way through the place x of the edge, whose y-component is -Y.
  double WayX(double x) const { return this->IsStrip ? -this->X : x - this->X; }
  /// The least distance in the interval.
  double Least() const
  {
    if (!this->IsStrip && this->X > this->Begin && this->X < this->End)
    {
      return this->Start - this->Y;
    }
    return std::min(this->AtBegin, this->AtEnd);
  }

  /// Whether ways by an end of the edge, where the times are known, are shorter everywhere in the
  /// window by more than a margin.
  bool IsLongerThanBy(double length, double atBegin, double atEnd, double margin) const
  {
    return atBegin + this->End < this->AtEnd - margin ||
      atEnd + (length - this->Begin) < this->AtBegin - margin;
  }

  /// The same window with the edge, of the given length, run through from its other end.
  void Mirror(double length)
  {
    std::swap(this->AtBegin, this->AtEnd);
    this->Begin = length - this->Begin;
    this->End = length - this->End;
    std::swap(this->Begin, this->End);
    if (this->IsStrip)
    {
      this->Start -= this->X * length;
      this->X = -this->X;
    }
    else
    {
      this->X = length - this->X;
    }
  }
  void SetBegin(double begin)
  {
    this->Begin = begin;
    this->AtBegin = this->At(begin);
  }
  void SetEnd(double end)
  {
    this->End = end;
    this->AtEnd = this->At(end);
  }
};

/// Memory for KeepShortestWindows().
struct WindowBuffers
{
  std::vector<GeodesicWindow> Kept, Later;
};

/// Cut windows on one edge, of the given length, so that where several of them overlap the one with
/// the shortest distance stays, and sort them along the edge. Windows that end at each other and
/// come from one place of the plane become one. Distances that differ by less than the part roundOff
/// count as equal, and windows that are past stay then.
void KeepShortestWindows(
  std::vector<GeodesicWindow>& windows, double length, double roundOff, WindowBuffers& buffers);

} // namespace SurfaceDiffusion
