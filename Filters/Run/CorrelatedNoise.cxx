// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CorrelatedNoise.h"

#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Core/Statistics/NoiseCorrelation.h"
#include "Run/Surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

Sentence DescribeSmoothData(double width, double estimate, double deviation, const Sentence& next)
{
  return Sentence(Word::Setting("NoiseLevel"))
    << ": the data show no white noise but are smooth over about " << width
    << " (full width at half maximum), as correlated noise is, so that its estimate, " << estimate
    << ", may be too small; without a signal the noise is " << deviation << " (" << next << ")";
}

Sentence DescribeSmoothValues(
  const ScatteredValues& data, int column, double estimate, double unit, const Surface& surface)
{
  constexpr Index sample = 300;
  const Index count = data.Count();
  const Points vertices = VertexPositions(surface);
  const double length = surface.InputMesh().LengthUnit();
  Points places = Points::Zero(count, 3);
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      places.row(i) +=
        length * data.Places[i].Coordinates[a] * vertices.row(data.Places[i].Vertices[a]);
    }
  }
  const Vector values = unit * data.Given.col(column);
  const double mean = data.Weights.dot(values) / data.Weights.sum();
  const double variance =
    data.Weights.dot((values.array() - mean).square().matrix()) / data.Weights.sum();
  if (values.minCoeff() == values.maxCoeff())
  {
    return {};
  }
  double squareDifference = 0.0; // between nearest places
  double squareDistance = 0.0;
  double pairs = 0.0;
  const Index stride = (count + sample - 1) / sample;
  for (Index i = 0; i < count; i += stride)
  {
    Index nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < count; ++j)
    {
      const double square = (places.row(j) - places.row(i)).squaredNorm();
      if (square > 0.0 && square < least)
      {
        nearest = j;
        least = square;
      }
    }
    if (nearest >= 0)
    {
      squareDifference += std::pow(values[nearest] - values[i], 2);
      squareDistance += least;
      pairs += 1.0;
    }
  }
  const double width =
    WidthOfCorrelation(squareDifference / pairs, variance, squareDistance / pairs);
  return DescribeSmoothData(std::max(width, std::sqrt(squareDistance / pairs)), estimate,
    std::sqrt(variance),
    Sentence("set ") << Word::Setting("NoiseLevel") << ", or turn " << Word::Setting("Exact")
                     << " on if there is no noise");
}

} // namespace SurfaceDiffusion
