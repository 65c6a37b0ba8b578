// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicWindow.h"

namespace SurfaceDiffusion
{

namespace
{

using Window = GeodesicWindow;

/// Which of two windows is shorter in an interval.
enum class Shorter
{
  First,
  Second,
  FirstThenSecond,
  SecondThenFirst,
  InTurns ///< it changes on both sides of a place
};

struct Comparison
{
  Shorter Which;
  double Change = 0.0; ///< where it changes
};

/// The place on the edge beside which the difference of two distances is even more or less, if there
/// is one: it lies between the places, two at most, where both distances are equal.
double PlaceBetweenChanges(const Window& a, const Window& b)
{
  if (a.IsStrip || b.IsStrip)
  {
    // Where the derivatives are the same: that of a strip is the same everywhere
    const Window& point = a.IsStrip ? b : a;
    const double slope = a.IsStrip ? a.X : b.X;
    return point.IsStrip
      ? point.Begin
      : point.X + point.Y * slope / std::sqrt(std::max(0.0, 1.0 - slope * slope));
  }
  // Both distances are equal at roots of a polynomial of degree two; this is its extremum.
  const double across = b.X - a.X, start = b.Start - a.Start;
  const double square = (start - across) * (start + across);
  return a.X + 0.5 * across * (1.0 + (a.Y - b.Y) * (a.Y + b.Y) / square);
}

/// Where both distances are equal, between places where their difference has opposite signs.
double FindChange(const Window& a, const Window& b, double begin, double end, double atBegin,
  double atEnd, double tolerance)
{
  // False position with the weights of Illinois
  int side = 0;
  double x = begin;
  for (int step = 0; step < 60; ++step)
  {
    x = begin + (end - begin) * (atBegin / (atBegin - atEnd));
    const double difference = a.At(x) - b.At(x);
    if (std::abs(difference) <= tolerance)
    {
      break;
    }
    if ((difference > 0.0) == (atBegin > 0.0))
    {
      begin = x;
      atBegin = difference;
      atEnd *= side == 1 ? 0.5 : 1.0;
      side = 1;
    }
    else
    {
      end = x;
      atEnd = difference;
      atBegin *= side == -1 ? 0.5 : 1.0;
      side = -1;
    }
  }
  return x;
}

/// roundOff: the part of the distance within which they count as equal; windows that are past are
/// shorter then.
Comparison Compare(const Window& a, const Window& b, double begin, double end, double roundOff)
{
  const auto at = [](const Window& w, double x) {
    return x == w.Begin ? w.AtBegin : x == w.End ? w.AtEnd : w.At(x);
  };
  const double aBegin = at(a, begin);
  const double tolerance = roundOff * aBegin;
  const double favour = tolerance * (int(b.IsPast) - int(a.IsPast));
  const double atBegin = aBegin - at(b, begin) + favour, atEnd = at(a, end) - at(b, end) + favour;
  if ((atBegin < 0.0 && atEnd > 0.0) || (atBegin > 0.0 && atEnd < 0.0))
  {
    return { atBegin < 0.0 ? Shorter::FirstThenSecond : Shorter::SecondThenFirst,
      FindChange(a, b, begin, end, atBegin, atEnd, tolerance) };
  }
  const bool first = atBegin + atEnd <= 0.0;
  const double between = PlaceBetweenChanges(a, b);
  if (between > begin && between < end)
  {
    const double difference = a.At(between) - b.At(between) + favour;
    if (first ? difference > tolerance : difference < -tolerance)
    {
      return { Shorter::InTurns, between };
    }
  }
  return { first ? Shorter::First : Shorter::Second };
}

bool ComeFromOnePlace(const Window& a, const Window& b)
{
  constexpr double roundOff = 2e-13;
  if (a.Source != b.Source || a.IsStrip != b.IsStrip || a.IsPast != b.IsPast)
  {
    return false;
  }
  const double scale = a.IsStrip ? 1.0 : a.AtEnd - a.Start;
  return std::abs(a.Start - b.Start) <= (a.IsStrip ? roundOff * (a.AtEnd + a.End) : 0.0) &&
    std::abs(a.X - b.X) <= roundOff * scale && std::abs(a.Y - b.Y) <= roundOff * scale;
}

} // namespace

void KeepShortestWindows(
  std::vector<Window>& windows, double length, double roundOff, WindowBuffers& buffers)
{
  const double least = 1e-14 * length;
  const auto before = [](const Window& a, const Window& b) { return a.Begin < b.Begin; };
  if (!std::is_sorted(windows.begin(), windows.end(), before))
  {
    std::sort(windows.begin(), windows.end(), before);
  }
  const auto meet = [&](const Window& a, const Window& b)
  { return b.Begin < a.End - least || (b.Begin < a.End + least && ComeFromOnePlace(a, b)); };
  if (std::adjacent_find(windows.begin(), windows.end(), meet) == windows.end())
  {
    return;
  }
  std::vector<Window>& kept = buffers.Kept;
  std::vector<Window>& later = buffers.Later;
  kept.clear();
  later.clear();
  const auto insert = [&](const Window& w)
  {
    if (w.End - w.Begin > least)
    {
      // `later` is a stack: the next window is its last
      auto place = later.end();
      while (place != later.begin() && (place - 1)->Begin < w.Begin)
      {
        --place;
      }
      later.insert(place, w);
    }
  };
  for (std::size_t next = 0; next < windows.size() || !later.empty();)
  {
    Window w = windows[0];
    if (later.empty() || (next < windows.size() && windows[next].Begin <= later.back().Begin))
    {
      w = windows[next++];
    }
    else
    {
      w = later.back();
      later.pop_back();
    }
    while (true)
    {
      if (kept.empty())
      {
        kept.push_back(w);
        break;
      }
      Window& last = kept.back();
      if (w.Begin <= last.End + least && ComeFromOnePlace(last, w))
      {
        if (w.End > last.End)
        {
          last.End = w.End;
          last.AtEnd = w.AtEnd;
        }
        break;
      }
      const double end = std::min(last.End, w.End);
      if (end - w.Begin <= least)
      {
        kept.push_back(w);
        break;
      }
      const Comparison comparison = Compare(last, w, w.Begin, end, roundOff);
      if (comparison.Which == Shorter::InTurns)
      {
        Window rest = w;
        rest.SetBegin(comparison.Change);
        insert(rest);
        w.SetEnd(comparison.Change);
        continue;
      }
      if (comparison.Which == Shorter::First || comparison.Which == Shorter::FirstThenSecond)
      {
        // w gives way at its beginning
        const bool whole = comparison.Which == Shorter::First;
        if (!whole && last.End > w.End)
        {
          Window rest = last;
          rest.SetBegin(w.End);
          insert(rest);
        }
        if (!whole)
        {
          last.SetEnd(comparison.Change);
        }
        w.SetBegin(whole ? end : comparison.Change);
        insert(w);
        break;
      }
      // `last` gives way at the beginning of w, and goes on where w is not shorter.
      const double until = comparison.Which == Shorter::Second ? end : comparison.Change;
      if (last.End - until > least)
      {
        Window rest = last;
        rest.SetBegin(until);
        insert(rest);
      }
      if (comparison.Which == Shorter::SecondThenFirst)
      {
        if (w.End > end)
        {
          Window rest = w;
          rest.SetBegin(end);
          insert(rest);
        }
        w.SetEnd(until);
      }
      if (w.Begin - last.Begin > least)
      {
        last.SetEnd(w.Begin);
        if (w.End - w.Begin > least)
        {
          kept.push_back(w);
        }
        break;
      }
      kept.pop_back();
    }
  }
  windows.swap(kept);
}

} // namespace SurfaceDiffusion
