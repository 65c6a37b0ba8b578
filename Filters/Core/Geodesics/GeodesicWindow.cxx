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
  Unknown
};

struct Comparison
{
  Shorter Which;
  double Change = 0.0; ///< where it changes
};

/// The lower bound of a function whose derivative is between -fall and rise, from its values at the
/// ends of an interval.
double LowerBound(double atBegin, double atEnd, double fall, double rise, double width)
{
  if (fall <= 0.0)
  {
    return atBegin;
  }
  if (rise <= 0.0)
  {
    return atEnd;
  }
  const double down = (atBegin - atEnd + rise * width) / (fall + rise);
  return atBegin - fall * std::clamp(down, 0.0, width);
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

/// A window at two places of the edge.
struct Piece
{
  const Window& Of;
  double AtBegin, AtEnd;

  Piece(const Window& window, double begin, double end)
    : Of(window)
    , AtBegin(begin == window.Begin ? window.AtBegin : window.At(begin))
    , AtEnd(end == window.End ? window.AtEnd : window.At(end))
  {
  }
};

/// Whether a is nowhere longer than b by more than the tolerance. It is not at the ends.
bool IsNowhereLonger(
  const Piece& a, const Piece& b, double begin, double end, double tolerance, int bisections)
{
  // The derivatives of both distances grow along the edge.
  const double fall = a.Of.SlopeAt(end, a.AtEnd) - b.Of.SlopeAt(begin, b.AtBegin);
  const double rise = b.Of.SlopeAt(end, b.AtEnd) - a.Of.SlopeAt(begin, a.AtBegin);
  if (LowerBound(b.AtBegin - a.AtBegin, b.AtEnd - a.AtEnd, fall, rise, end - begin) >= -tolerance)
  {
    return true;
  }
  const double middle = 0.5 * (begin + end);
  if (bisections == 0 || a.Of.At(middle) > b.Of.At(middle) + tolerance)
  {
    return false;
  }
  return IsNowhereLonger(Piece(a.Of, begin, middle), Piece(b.Of, begin, middle), begin, middle,
           tolerance, bisections - 1) &&
    IsNowhereLonger(
      Piece(a.Of, middle, end), Piece(b.Of, middle, end), middle, end, tolerance, bisections - 1);
}

Comparison Compare(const Window& first, const Window& second, double begin, double end)
{
  constexpr double roundOff = 1e-14;
  constexpr int bisections = 6;
  const Piece a(first, begin, end), b(second, begin, end);
  const double tolerance = roundOff * a.AtBegin;
  const double favour = tolerance * (int(second.IsPast) - int(first.IsPast));
  const double atBegin = a.AtBegin - b.AtBegin + favour, atEnd = a.AtEnd - b.AtEnd + favour;
  if ((atBegin < 0.0 && atEnd > 0.0) || (atBegin > 0.0 && atEnd < 0.0))
  {
    return { atBegin < 0.0 ? Shorter::FirstThenSecond : Shorter::SecondThenFirst,
      FindChange(first, second, begin, end, atBegin, atEnd, tolerance) };
  }
  if (atBegin <= 0.0 && atEnd <= 0.0 && IsNowhereLonger(a, b, begin, end, tolerance, bisections))
  {
    return { Shorter::First };
  }
  if (atBegin >= 0.0 && atEnd >= 0.0 && IsNowhereLonger(b, a, begin, end, tolerance, bisections))
  {
    return { Shorter::Second };
  }
  return { Shorter::Unknown };
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

void KeepShortestWindows(std::vector<Window>& windows, double length, WindowBuffers& buffers)
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
  auto& [kept, later] = buffers;
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
      const Comparison comparison = Compare(last, w, w.Begin, end);
      if (comparison.Which == Shorter::Unknown)
      {
        kept.push_back(w);
        break;
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
