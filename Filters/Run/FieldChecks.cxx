// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/FieldChecks.h"

#include "Run/Sentinels.h"

#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

Located<std::vector<Index>> AsLabels(const Located<std::vector<double>>& numbers, const Word& name)
{
  Located<std::vector<Index>> labels{ {}, numbers.OnCells };
  for (const double number : numbers.Values)
  {
    if (!(number >= 0.0 && number <= std::numeric_limits<Index>::max() &&
          number == std::floor(number)))
    {
      const Sentence place = numbers.OnCells ? Sentence(Word::Cell()) : Sentence("point");
      const Sentence places = numbers.OnCells ? Sentence(Word::Cells()) : Sentence("points");
      throw InputError(Sentence(name)
        << " is " << number << " at " << place << " " << labels.Values.size()
        << "; allowed: the labels 1 to " << Word::Setting("NumberOfRegions") << ", and 0 for "
        << places << " that are free");
    }
    labels.Values.push_back(static_cast<Index>(number));
  }
  return labels;
}

InputError ErrorOfFactor(const Word& name, double number, bool onCells, Eigen::Index row)
{
  return ErrorAt(name, Sentence("is ") << number, onCells, row, AllowedFactors(name.Name));
}

void RequireFiniteDirections(const Points& vectors, bool onCells, const Word& name)
{
  for (Eigen::Index i = 0; i < vectors.rows(); ++i)
  {
    if (vectors.row(i).array().isInf().any())
    {
      throw ErrorAt(name, "is infinite", onCells, i, "allowed: finite values and NaN");
    }
  }
}

void RequireRates(const Values& rates, const std::function<Eigen::Index(Index)>& cellOf)
{
  for (Index t = 0; t < static_cast<Index>(rates.rows()); ++t)
  {
    for (Eigen::Index k = 0; k < rates.cols(); ++k)
    {
      if (!(std::isfinite(rates(t, k)) && rates(t, k) >= 0.0))
      {
        throw ErrorOfFactor(Word::Array("DiffusionRateArray"), rates(t, k), true, cellOf(t));
      }
    }
  }
}

} // namespace SurfaceDiffusion
