// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/WindowFront.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

using Window = GeodesicWindow;

/// Whether the apex lies beside a window by no more than round-off. atEnd: the distance at the end
/// of the window there. beside: the vector product of the way through that end with the vector from
/// there to the apex. The way may turn at the end by an angle of 1e-10, or of round-off over the
/// length of the way to there, and is longer by its square then.
bool Touches(const Window& w, const EdgeFrames::Frame& frame, double atEnd, double beside)
{
  constexpr double angle = 1e-10, roundOff = 1e-14;
  if (w.IsStrip)
  {
    return beside <= angle * (frame.LeftLength + frame.RightLength);
  }
  const double x = frame.X - w.X, y = frame.Y - w.Y;
  const double side = angle * (atEnd - w.Start) + roundOff * frame.Length;
  return beside <= side * (std::abs(x) + y) && beside <= side * std::sqrt(x * x + y * y);
}

} // namespace

WindowFront::WindowFront(const TriangleMesh& mesh, const EdgeFrames& frames, double cutoff)
  : Times(static_cast<std::size_t>(mesh.NumberOfVertices()), Never)
  , Sources(this->Times.size(), -1)
  , Mesh(mesh)
  , Frames(frames)
  , Cutoff(cutoff)
  , Ways(this->Times.size())
  , WaitingAt(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()), -1)
  , TimesCrossed(this->WaitingAt.size(), 0)
{
}

WindowFront::LastPart WindowFront::LastPartOver(
  Index edge, const Window& w, const Eigen::Vector2d& place)
{
  if (!w.IsStrip)
  {
    return { -1, edge, true, { w.X, w.Y }, w.Start };
  }
  const double x = std::clamp(
    w.Y < 0.0 ? place[0] - place[1] * w.X / w.Y : place[0], w.Begin, w.End); // of the crossing
  const double distance = w.At(x);
  return { -1, edge, true, { x + distance * w.X, std::min(0.0, distance * w.Y) }, 0.0 };
}

void WindowFront::Reach(Index vertex, double time, Index source, const Incoming& incoming)
{
  const auto v = static_cast<std::size_t>(vertex);
  if (!(time < this->Times[v]) || time > this->Cutoff)
  {
    return;
  }
  if (this->Times[v] == Never)
  {
    this->Reached.push_back(vertex);
  }
  this->Times[v] = time;
  this->Sources[v] = source;
  this->Ways[v] = incoming;
  if (incoming.Corner < 0 || this->Frames.PassingAt(vertex) != EdgeFrames::Passing::None)
  {
    this->Queue.emplace(time, -1 - vertex);
  }
}

void WindowFront::GoOver(Index edge, bool reversed, std::uint32_t behind, const Window& window)
{
  const double least = window.Least();
  if (least > this->Cutoff)
  {
    return;
  }
  this->Frames.ForEachBehind(edge, reversed, behind,
    [&](Index other, bool mirrored)
    {
      Index& place = this->WaitingAt[static_cast<std::size_t>(other)];
      if (place < 0)
      {
        if (this->Free.empty())
        {
          this->Free.push_back(static_cast<Index>(this->Pool.size()));
          this->Pool.emplace_back();
        }
        place = this->Free.back();
        this->Free.pop_back();
        Waiting& waiting = this->Pool[static_cast<std::size_t>(place)];
        waiting.Least = waiting.Queued = Never;
      }
      Waiting& waiting = this->Pool[static_cast<std::size_t>(place)];
      waiting.Windows.push_back(window);
      if (mirrored)
      {
        waiting.Windows.back().Mirror(this->Frames[other].Length);
      }
      waiting.Least = std::min(waiting.Least, least);
      if (!waiting.IsChanged)
      {
        waiting.IsChanged = true;
        this->Changed.push_back(other);
      }
    });
}

void WindowFront::QueueChanged()
{
  for (const Index edge : this->Changed)
  {
    Waiting& waiting =
      this->Pool[static_cast<std::size_t>(this->WaitingAt[static_cast<std::size_t>(edge)])];
    waiting.IsChanged = false;
    if (waiting.Least < waiting.Queued)
    {
      waiting.Queued = waiting.Least;
      this->Queue.emplace(waiting.Least, edge);
    }
  }
  this->Changed.clear();
}

void WindowFront::Run(
  const ProgressMonitor& progress, const Watch& watch, const std::function<bool(double)>& isDone)
{
  progress.Report(0.0); // a small surface has no other report
  std::vector<Window> windows;
  long long steps = 0;
  for (this->QueueChanged(); !this->Queue.empty(); this->QueueChanged())
  {
    const auto [least, edge] = this->Queue.top();
    if (isDone && isDone(least))
    {
      this->DropWaiting();
      break;
    }
    this->Queue.pop();
    if (edge < 0)
    {
      if (least == this->Times[static_cast<std::size_t>(-1 - edge)])
      {
        this->LeaveVertex(-1 - edge);
      }
      continue;
    }
    const Index place = this->WaitingAt[static_cast<std::size_t>(edge)];
    if (place < 0 || least != this->Pool[static_cast<std::size_t>(place)].Least)
    {
      continue;
    }
    if (++steps % 4096 == 0)
    {
      progress.Report(
        static_cast<double>(this->Reached.size()) / static_cast<double>(this->Times.size()));
    }
    windows.swap(this->Pool[static_cast<std::size_t>(place)].Windows); // empty ones for these
    this->WaitingAt[static_cast<std::size_t>(edge)] = -1;
    this->Free.push_back(place);
    this->CrossTriangle(edge, windows);
    if (watch && this->Watched[static_cast<std::size_t>(edge / 3)])
    {
      watch(edge, windows);
    }
    windows.clear();
  }
}

void WindowFront::DropWaiting()
{
  for (; !this->Queue.empty(); this->Queue.pop())
  {
    const Index edge = this->Queue.top().second;
    if (edge >= 0 && this->WaitingAt[static_cast<std::size_t>(edge)] >= 0)
    {
      Index& place = this->WaitingAt[static_cast<std::size_t>(edge)];
      this->Pool[static_cast<std::size_t>(place)].Windows.clear();
      this->Free.push_back(place);
      place = -1;
    }
  }
}

void WindowFront::Clear()
{
  for (const Index vertex : this->Reached)
  {
    const auto v = static_cast<std::size_t>(vertex);
    this->Times[v] = Never;
    this->Sources[v] = -1;
    this->Ways[v] = {};
  }
  for (const Index edge : this->Crossed)
  {
    this->TimesCrossed[static_cast<std::size_t>(edge)] = 0;
  }
  this->Reached.clear();
  this->Pieces.clear();
  this->Crossed.clear();
  this->Past.clear();
}

std::vector<Window>* WindowFront::PastAt(Index edge, double& roundOff)
{
  constexpr unsigned char often = 4, most = 64;
  unsigned char& times = this->TimesCrossed[static_cast<std::size_t>(edge)];
  roundOff = 1e-14;
  if (times == 0)
  {
    this->Crossed.push_back(edge);
  }
  if (times < often)
  {
    ++times;
    return nullptr;
  }
  roundOff = times < most ? 1e-12 : 1e-11;
  times = std::min<unsigned char>(most, static_cast<unsigned char>(times + 1));
  return &this->Past[edge];
}

void WindowFront::CrossTriangle(Index edge, std::vector<Window>& windows)
{
  const EdgeFrames::Frame& frame = this->Frames[edge];
  const Index begin = CornerAfter(edge, 1), end = CornerAfter(edge, 2);
  const double atBegin = this->TimeAt(begin), atEnd = this->TimeAt(end);
  const double margin = 2e-14 * (windows[0].AtBegin + frame.Length);
  double roundOff = 0.0;
  std::vector<Window>* const past = this->PastAt(edge, roundOff);
  bool byBegin = false, byEnd = false;
  const auto useless = [&](const Window& w)
  {
    if (w.IsLongerThanBy(frame.Length, atBegin, atEnd, margin))
    {
      return true;
    }
    if (!past)
    {
      return false;
    }
    // Ways that are hardly shorter than those by a vertex turn there.
    const double gain = roundOff * (w.AtBegin + frame.Length);
    const bool nearBegin = atBegin + w.End < w.AtEnd + gain;
    const bool nearEnd = !nearBegin && atEnd + (frame.Length - w.Begin) < w.AtBegin + gain;
    byBegin = byBegin || nearBegin;
    byEnd = byEnd || nearEnd;
    return nearBegin || nearEnd;
  };
  windows.erase(std::remove_if(windows.begin(), windows.end(), useless), windows.end());
  if (byBegin)
  {
    this->LeaveEverywhere(this->VertexAt(begin));
  }
  if (byEnd)
  {
    this->LeaveEverywhere(this->VertexAt(end));
  }
  if (past)
  {
    windows.insert(windows.end(), past->begin(), past->end());
  }
  KeepShortestWindows(windows, frame.Length, roundOff, this->Buffers);
  if (past)
  {
    *past = windows;
    std::for_each(past->begin(), past->end(), [](Window& w) { w.IsPast = true; });
  }
  for (const Window& w : windows)
  {
    if (w.IsPast)
    {
      continue;
    }
    // The apex from the ways through both ends of the window, of which the one through the begin is
    // the left one
    const double beginX = w.WayX(w.Begin), endX = w.WayX(w.End), wayY = -w.Y;
    const double fromBegin = beginX * frame.Y - wayY * (frame.X - w.Begin);
    const double fromEnd = endX * frame.Y - wayY * (frame.X - w.End);
    const bool sees = fromBegin <= 0.0 && fromEnd >= 0.0;
    double atApex = Never;
    if (sees ||
      Touches(w, frame, fromBegin > 0.0 ? w.AtBegin : w.AtEnd, std::max(fromBegin, -fromEnd)))
    {
      const double wayToX = w.IsStrip ? -w.X : frame.X - w.X;
      const double wayToY = w.IsStrip ? -w.Y : frame.Y - w.Y;
      atApex = w.IsStrip ? w.Start + wayToX * frame.X + wayToY * frame.Y
                         : w.Start + std::sqrt(wayToX * wayToX + wayToY * wayToY);
      if (atApex < this->TimeAt(edge))
      {
        const double angle =
          std::atan2(frame.X * wayToY - frame.Y * wayToX, frame.X * wayToX + frame.Y * wayToY);
        this->Reach(this->VertexAt(edge), atApex, w.Source,
          { edge, std::max(0.0, angle), LastPartOver(edge, w, { frame.X, frame.Y }) });
      }
    }
    if (fromBegin < 0.0)
    {
      this->CrossCorner(edge, true, w, sees, atApex);
    }
    if (fromEnd > 0.0)
    {
      this->CrossCorner(edge, false, w, sees, atApex);
    }
  }
}

void WindowFront::CrossCorner(
  Index edge, bool left, const Window& window, bool seesApex, double atApex)
{
  const EdgeFrames::Frame& frame = this->Frames[edge];
  Window w = window;
  if (!left)
  {
    w.Mirror(frame.Length);
  }
  const double length = left ? frame.LeftLength : frame.RightLength;
  const double over = left ? frame.OverLeft : frame.OverRight;
  const double ux = (left ? frame.X : frame.Length - frame.X) * over, uy = frame.Y * over;
  const double wayY = -w.Y;
  // Where the ways through the ends of the window meet the edge
  const auto meet = [&](double x)
  {
    const double across = ux * wayY - uy * w.WayX(x);
    const double along = x * wayY;
    return along < across * length ? along / across : length;
  };
  Window next;
  next.Begin = w.Begin > 0.0 ? meet(w.Begin) : 0.0;
  next.End = seesApex ? length : meet(w.End);
  if (next.End - next.Begin <= 1e-14 * length)
  {
    return;
  }
  next.X = w.X * ux + w.Y * uy;
  next.Y = std::min(0.0, w.Y * ux - w.X * uy);
  next.Start = w.Start;
  next.Source = w.Source;
  next.IsStrip = w.IsStrip;
  next.IsPast = false;
  next.AtBegin = next.At(next.Begin);
  next.AtEnd = seesApex ? atApex : next.At(next.End);
  const double atBegin = this->TimeAt(CornerAfter(edge, left ? 1 : 2)), atEnd = this->TimeAt(edge);
  const double margin = 2e-14 * (next.AtBegin + frame.Length);
  if (next.IsLongerThanBy(length, atBegin, atEnd, margin))
  {
    return;
  }
  // From the corner that is not on the edge
  const double more = next.AtBegin - margin - this->TimeAt(CornerAfter(edge, left ? 2 : 1));
  if (more > 0.0)
  {
    const double dx = frame.Length - next.Begin * ux, dy = next.Begin * uy;
    if (dx * dx + dy * dy < more * more)
    {
      return;
    }
  }
  if (left)
  {
    this->GoOver(CornerAfter(edge, 2), true, frame.BehindLeft, next);
  }
  else
  {
    this->GoOver(CornerAfter(edge, 1), false, frame.BehindRight, next);
  }
}

} // namespace SurfaceDiffusion
