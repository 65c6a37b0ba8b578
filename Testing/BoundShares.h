// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

/// How much of its bound a number of a test uses. This header comes before each file of a test program,
/// and EXPECT_NEAR, EXPECT_LE, EXPECT_LT and their twins with ASSERT do as GoogleTest's. If
/// SURFACEDIFFUSION_BOUND_SHARES is set, a file of that name gets a line at the end of the program for
/// each of them in the sources: file and line, the bound as it is written, and the largest share.
/// Testing/bound_shares.py compares builds.
namespace SurfaceDiffusion::Testing
{

class BoundShares
{
public:
  static BoundShares& Instance()
  {
    static BoundShares shares;
    return shares;
  }
  bool AreWanted() const { return this->Path != nullptr; }
  void Record(const char* file, int line, const char* bound, double value, double limit)
  {
    const double share = limit > 0.0 && !(value < 0.0) ? value / limit : 0.0;
    const std::lock_guard<std::mutex> lock(this->Guard);
    double& largest = this->Largest[{ std::string(file) + ":" + std::to_string(line), bound }];
    largest = share <= largest ? largest : share; // keeps NaN
  }

private:
  BoundShares() = default;
  ~BoundShares()
  {
    std::ofstream file;
    if (this->AreWanted())
    {
      file.open(this->Path, std::ios::app);
    }
    for (const auto& [place, share] : this->Largest)
    {
      file << place.first << '\t' << place.second << '\t' << share << '\n';
    }
  }

  const char* const Path = std::getenv("SURFACEDIFFUSION_BOUND_SHARES");
  std::mutex Guard;
  std::map<std::pair<std::string, std::string>, double> Largest;
};

/// A predicate of GoogleTest that records the share first.
struct Recorded
{
  const char* File;
  int Line;
  bool MayBeEqual;

  testing::AssertionResult operator()(const char* aText, const char* bText, const char* boundText,
    double a, double b, double bound) const
  {
    this->Record(boundText, std::abs(a - b), bound);
    return testing::internal::DoubleNearPredFormat(aText, bText, boundText, a, b, bound);
  }
  template <typename A, typename B>
  testing::AssertionResult operator()(
    const char* aText, const char* bText, const A& a, const B& b) const
  {
    if constexpr (std::is_floating_point_v<A> && std::is_arithmetic_v<B>)
    {
      this->Record(bText, static_cast<double>(a), static_cast<double>(b));
    }
    return this->MayBeEqual ? testing::internal::CmpHelperLE(aText, bText, a, b)
                            : testing::internal::CmpHelperLT(aText, bText, a, b);
  }

private:
  void Record(const char* bound, double value, double limit) const
  {
    if (BoundShares::Instance().AreWanted())
    {
      BoundShares::Instance().Record(this->File, this->Line, bound, value, limit);
    }
  }
};

} // namespace SurfaceDiffusion::Testing

#define SURFACEDIFFUSION_RECORDED(mayBeEqual)                                                      \
  (SurfaceDiffusion::Testing::Recorded{ __FILE__, __LINE__, mayBeEqual })
#undef EXPECT_NEAR
#undef ASSERT_NEAR
#undef EXPECT_LE
#undef EXPECT_LT
#undef ASSERT_LE
#undef ASSERT_LT
#define EXPECT_NEAR(a, b, bound) EXPECT_PRED_FORMAT3(SURFACEDIFFUSION_RECORDED(true), a, b, bound)
#define ASSERT_NEAR(a, b, bound) ASSERT_PRED_FORMAT3(SURFACEDIFFUSION_RECORDED(true), a, b, bound)
#define EXPECT_LE(a, b) EXPECT_PRED_FORMAT2(SURFACEDIFFUSION_RECORDED(true), a, b)
#define EXPECT_LT(a, b) EXPECT_PRED_FORMAT2(SURFACEDIFFUSION_RECORDED(false), a, b)
#define ASSERT_LE(a, b) ASSERT_PRED_FORMAT2(SURFACEDIFFUSION_RECORDED(true), a, b)
#define ASSERT_LT(a, b) ASSERT_PRED_FORMAT2(SURFACEDIFFUSION_RECORDED(false), a, b)
