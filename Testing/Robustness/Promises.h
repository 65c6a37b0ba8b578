// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AllFilters.h"

#include "vtkIdList.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

/// The promises of each class for any surface, as its header states them. The input's data are
/// positive and complete.
namespace FilterTest
{

inline std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A column of the history, which has the start and at least one step, in finite numbers.
inline std::vector<double> HistoryColumn(vtkAlgorithm* filter, const char* column)
{
  std::vector<double> values;
  for (vtkIdType row = 0; row < History(filter)->GetNumberOfRows(); ++row)
  {
    values.push_back(HistoryAt(filter, row, column));
    EXPECT_TRUE(std::isfinite(values.back())) << column << " of step " << row;
  }
  EXPECT_GE(values.size(), 2u) << column;
  return values;
}

/// The largest change of a total, relative to the first, or to 1 if that is 0; NaN if a total is
/// not a number, or if there is none.
inline double LargestChange(const std::vector<double>& totals)
{
  double largest = totals.empty() ? std::nan("") : 0.0;
  for (const double total : totals)
  {
    const double change =
      std::abs(total - totals[0]) / (totals[0] == 0.0 ? 1.0 : std::abs(totals[0]));
    largest = std::isnan(largest) || change <= largest ? largest : change; // keeps NaN
  }
  return largest;
}

/// The number of steps whose energy is not below that of the step before, up to round-off: also
/// those where it is not a number.
inline int NumberOfRises(const std::vector<double>& energies)
{
  int rises = 0;
  for (std::size_t step = 1; step < energies.size(); ++step)
  {
    rises += !(energies[step] <= energies[step - 1] + 1e-9 * energies[0]);
  }
  return rises;
}

inline std::string FallOf(const std::vector<double>& energies)
{
  const bool fell = !energies.empty() && energies[0] > 0.0;
  return Text("energy fell to %.4f", fell ? energies.back() / energies[0] : 1.0);
}

/// Sum A_i u_i of every state is that of the start, up to a relative error of 1e-12. Weights w of the
/// fidelity conserve sum A_i w_i u_i instead, which no history has. Tangent vectors turn on their way.
inline std::string ExpectTotalIsConserved(vtkAlgorithm* filter)
{
  if (HasInputArray(filter, 5))
  {
    return "weighted";
  }
  auto* const heat = vtkFVMHeatFilter::SafeDownCast(filter);
  if (heat && heat->GetVectorType() == vtkFVMHeatFilter::VECTOR_TYPE_TANGENT)
  {
    return "vectors";
  }
  const double change = LargestChange(HistoryColumn(filter, "Total_0"));
  EXPECT_LE(change, 1e-12);
  return Text("sum changed by %.1e", change);
}

/// The energy of no step is above that of the step before, up to round-off.
inline std::string ExpectEnergyFalls(vtkAlgorithm* filter)
{
  const std::vector<double> energies = HistoryColumn(filter, "Energy");
  EXPECT_EQ(NumberOfRises(energies), 0) << testing::PrintToString(energies);
  return FallOf(energies);
}

/// The same for the Mumford-Shah model, whose energy can rise in the two steps where eps is halved.
inline std::string ExpectEnergyFallsInStages(vtkAlgorithm* filter)
{
  const std::vector<double> energies = HistoryColumn(filter, "Energy");
  EXPECT_LE(NumberOfRises(energies), 2) << testing::PrintToString(energies);
  return FallOf(energies);
}

/// The result has no value outside the range of the data, up to the solver's tolerance.
inline std::string ExpectStaysInRange(vtkDataArray* given, vtkDataArray* u)
{
  double data[2];
  double result[2];
  given->GetRange(data);
  u->GetRange(result);
  const double overshoot = std::max({ 0.0, data[0] - result[0], result[1] - data[1] });
  EXPECT_TRUE(std::isfinite(result[0]) && std::isfinite(result[1]));
  EXPECT_LE(overshoot, 1e-9 * (data[1] - data[0]));
  return Text("overshoot %.1e", overshoot);
}

/// The uniform steady state of the default texture, u1 = u2 = gamma - mu at the points that take
/// part and 0 at all others.
inline vtkSmartPointer<vtkTuringTextureFilter> UniformState(vtkPolyData* surface)
{
  auto uniform = vtkSmartPointer<vtkTuringTextureFilter>::New();
  uniform->SetInputData(surface);
  uniform->SetInitialNoise(0.0);
  uniform->SetNumberOfTimeSteps(0);
  Messages messages(uniform);
  uniform->Update();
  return uniform;
}

/// The area of the participating triangles.
inline double AreaOf(vtkPolyData* surface)
{
  const auto uniform = UniformState(surface);
  return HistoryAt(uniform, 0, "Total_1") / (uniform->GetGrowthRate() - uniform->GetDecayRate());
}

/// Vectors have length 1 at points that take part.
inline std::string ExpectUnitLength(vtkPolyData* surface, vtkDataArray* u)
{
  const double tolerance = u->GetDataType() == VTK_FLOAT ? 1e-6 : 1e-12;
  const auto uniform = UniformState(surface);
  double largest = 0.0;
  for (vtkIdType i = 0; i < u->GetNumberOfTuples(); ++i)
  {
    if (Result(uniform, "u1")->GetComponent(i, 0) != 0.0)
    {
      largest = std::max(largest, std::abs(vtkMath::Norm(u->GetTuple3(i)) - 1.0));
    }
  }
  EXPECT_LE(largest, tolerance);
  return Text("length changed by %.1e", largest);
}

/// The normal of a triangle, divided by the square of the longest edge and thus at any scale. Its
/// length is between half the sine of the smallest angle and this sine.
struct UnitTriangle
{
  UnitTriangle(vtkPolyData* surface, vtkIdList* corners)
  {
    double p[3][3];
    for (int a = 0; a < 3; ++a)
    {
      surface->GetPoint(corners->GetId(a), p[a]);
    }
    vtkMath::Subtract(p[1], p[0], p[1]);
    vtkMath::Subtract(p[2], p[0], p[2]);
    double last[3];
    vtkMath::Subtract(p[2], p[1], last);
    const double longest =
      std::max({ vtkMath::Norm(p[1]), vtkMath::Norm(p[2]), vtkMath::Norm(last) });
    if (longest > 0.0)
    {
      vtkMath::MultiplyScalar(p[1], 1.0 / longest);
      vtkMath::MultiplyScalar(p[2], 1.0 / longest);
      vtkMath::Cross(p[1], p[2], this->Normal);
    }
    this->Sine = vtkMath::Norm(this->Normal);
  }

  double Normal[3] = { 0.0, 0.0, 0.0 };
  double Sine = 0.0;
};

/// The coordinates of a triangle with a small angle determine its normal and its weights only up to
/// this relative error.
inline double RoundingOf(double sine)
{
  return 1e-15 / std::max(sine, 1e-15);
}

/// Directions of triangles lie in their triangle and have length 1, or are zero.
inline std::string ExpectTangentialUnitOrZero(vtkPolyData* surface, vtkDataArray* directions)
{
  double normalPart = 0.0;
  vtkIdType zeros = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    double d[3];
    directions->GetTuple(cell, d);
    const double length = vtkMath::Norm(d);
    if (length == 0.0)
    {
      ++zeros;
      continue;
    }
    surface->GetCellPoints(cell, corners);
    if (corners->GetNumberOfIds() != 3)
    {
      EXPECT_NEAR(length, 1.0, 1e-12) << "cell " << cell;
      continue;
    }
    const UnitTriangle triangle(surface, corners);
    EXPECT_NEAR(length, 1.0, 1e-12 + RoundingOf(triangle.Sine)) << "cell " << cell;
    normalPart = std::max(normalPart, std::abs(vtkMath::Dot(d, triangle.Normal)));
  }
  EXPECT_LE(normalPart, 1e-12);
  return Text("normal part %.1e, ", normalPart) +
    Text("%.0f without direction", static_cast<double>(zeros));
}

/// H and K are half the sum and the product of the principal curvatures, all of which are finite.
inline std::string ExpectConsistentCurvatures(vtkPolyData* output)
{
  vtkPointData* const arrays = output->GetPointData();
  vtkDataArray* const principal = arrays->GetArray("PrincipalCurvatures");
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const double larger = principal->GetComponent(i, 0);
    const double smaller = principal->GetComponent(i, 1);
    const double scale = std::abs(larger) + std::abs(smaller);
    EXPECT_TRUE(std::isfinite(scale) && larger >= smaller);
    EXPECT_NEAR(arrays->GetArray("MeanCurvature")->GetComponent(i, 0), 0.5 * (larger + smaller),
      1e-9 * scale);
    EXPECT_LE(std::abs(arrays->GetArray("ShapeIndex")->GetComponent(i, 0)), 1.0);
  }
  return "consistent curvatures";
}

/// Distances are 0 at the sources; with a sign they are below 0 at the points of a region and above 0 at
/// all others. Arrival times, which are found on the triangles of the surface itself, differ along no edge by
/// more than its length takes at the smallest speed.
inline std::string ExpectDistances(vtkPolyData* input, vtkPolyData* output, vtkDataArray* times,
  bool isMarched, bool isSigned, double smallestSpeed)
{
  vtkDataArray* const sources = input->GetPointData()->GetArray("sources");
  const bool isOfEdges = std::string(times->GetName()) == "ArrivalTime";
  const auto placeOf = [&](vtkIdType i)
  {
    std::array<double, 3> x;
    input->GetPoint(i, x.data());
    return x;
  };
  std::set<std::array<double, 3>> inside; // points at one place are one vertex of flat triangles
  for (vtkIdType i = 0; isSigned && sources && i < sources->GetNumberOfTuples(); ++i)
  {
    if (sources->GetComponent(i, 0) != 0.0)
    {
      inside.insert(placeOf(i));
    }
  }
  double largest = 0.0;
  int zeros = 0;
  for (vtkIdType i = 0; i < times->GetNumberOfTuples(); ++i)
  {
    const double time = times->GetComponent(i, 0);
    const bool isSource = sources && sources->GetComponent(i, 0) != 0.0;
    const bool isInside = !std::isinf(time) && inside.count(placeOf(i)) > 0;
    EXPECT_GE(isInside ? -time : time, 0.0) << i;
    EXPECT_TRUE(isSigned || !isMarched || !isSource || time == 0.0 || std::isinf(time)) << i;
    zeros += time == 0.0 || isSigned ? 1 : 0;
    largest = std::isfinite(time) ? std::max(largest, time) : largest;
  }
  EXPECT_TRUE(zeros > 0 || largest == 0.0); // without area, nothing is reached
  for (vtkIdType c = 0; c < input->GetNumberOfCells() && isOfEdges; ++c)
  {
    vtkNew<vtkIdList> corners;
    output->GetCellPoints(c, corners);
    double p[3][3];
    for (int a = 0; a < 3; ++a)
    {
      output->GetPoint(corners->GetId(a), p[a]);
    }
    const double area = vtkTriangle::TriangleArea(p[0], p[1], p[2]);
    for (int a = 0; a < 3; ++a)
    {
      const vtkIdType i = corners->GetId(a);
      const vtkIdType j = corners->GetId((a + 1) % 3);
      const double difference = std::abs(times->GetComponent(i, 0) - times->GetComponent(j, 0));
      const double square = vtkMath::Distance2BetweenPoints(p[a], p[(a + 1) % 3]);
      if (area > 1e-12 * square && std::isfinite(difference)) // others may carry no front
      {
        const double longest = std::sqrt(square) / smallestSpeed;
        EXPECT_LE(difference, longest * (1.0 + 1e-9) + 1e-12 * largest) << i << ' ' << j;
      }
    }
  }
  return "at most " + std::to_string(largest);
}

/// The points of the output are those of the input plus the displacements, which are finite.
inline std::string ExpectMovedPoints(
  vtkPolyData* input, vtkPolyData* output, vtkDataArray* displacements)
{
  const double roundOff = input->GetPoints()->GetDataType() == VTK_FLOAT ? 1e-6 : 1e-14;
  double largest = 0.0;
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double from = input->GetPoint(i)[k];
      const double to = output->GetPoint(i)[k];
      const double moved = displacements->GetComponent(i, k);
      EXPECT_TRUE(std::isfinite(moved)) << "point " << i;
      const double size = std::abs(from) + std::abs(to) + std::abs(moved);
      EXPECT_LE(std::abs(to - from - moved), roundOff * size) << "point " << i;
      largest = std::max(largest, std::abs(moved));
    }
  }
  return Text("points moved by %.1e", largest);
}

/// Points move by at most twice their heights.
inline std::string ExpectRelief(vtkPolyData* input, vtkPolyData* output, vtkDataArray* heights)
{
  const double roundOff = input->GetPoints()->GetDataType() == VTK_FLOAT ? 1e-6 : 1e-14;
  double largest = 0.0;
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    double from[3], to[3];
    input->GetPoint(i, from);
    output->GetPoint(i, to);
    const double height = std::abs(heights->GetComponent(i, 0));
    EXPECT_TRUE(std::isfinite(height)) << "point " << i;
    const double moved = std::sqrt(vtkMath::Distance2BetweenPoints(from, to));
    EXPECT_LE(moved, 2.0 * height + roundOff * (vtkMath::Norm(from) + height)) << "point " << i;
    largest = std::max(largest, height);
  }
  return Text("relief of up to %.1e", largest);
}

/// Concentrations are not negative, and the texture is in [0, 1].
inline std::string ExpectPatternBounds(vtkPolyDataAlgorithm* filter)
{
  const double u1 = Result(filter, "u1")->GetRange()[0];
  const double u2 = Result(filter, "u2")->GetRange()[0];
  EXPECT_GE(std::min(u1, u2), 0.0);
  EXPECT_GE(Result(filter, "Texture")->GetRange()[0], 0.0);
  EXPECT_LE(Result(filter, "Texture")->GetRange()[1], 1.0);
  return Text("smallest %.1e", std::min(u1, u2));
}

/// Diffusion conserves both totals, and the reactions (24) have F + G = s (gamma - mu - u2). A step
/// of the first-order scheme therefore changes the total of u1 + u2 by a known amount, to which
/// clamping can only add.
inline std::string ExpectReactionBalance(vtkTuringTextureFilter* filter, vtkPolyData* surface)
{
  const double area = AreaOf(surface);
  const double tolerance = 1e-11;
  const std::vector<double> times = HistoryColumn(filter, "Time");
  const std::vector<double> clamped = HistoryColumn(filter, "Clamped");
  const std::vector<double> u1 = HistoryColumn(filter, "Total_0");
  const std::vector<double> u2 = HistoryColumn(filter, "Total_1");
  const double supply = filter->GetGrowthRate() - filter->GetDecayRate();
  double largest = 0.0;
  for (std::size_t step = 1; step < times.size(); ++step)
  {
    const double before = u1[step - 1] + u2[step - 1];
    const double change = (times[step] - times[step - 1]) * (supply * area - u2[step - 1]);
    const double error = (u1[step] + u2[step] - before - change) / std::max(before, 1e-300);
    EXPECT_GE(error, -tolerance) << "step " << step;
    if (clamped[step] == 0.0)
    {
      EXPECT_LE(error, tolerance) << "step " << step;
      largest = std::max(largest, std::abs(error));
    }
  }
  return Text("balance to %.1e", largest);
}

/// Labels are 1 .. K, and 0 at points that take no part. Probabilities are in [0, 1], and their sum
/// is 1 at the others.
inline std::string ExpectLabelsAndProbabilities(
  vtkSurfaceSegmentationFilter* filter, vtkDataArray* labels)
{
  vtkDataArray* const probabilities = ResultOf(filter, "RegionProbability");
  double largest = 0.0;
  for (vtkIdType i = 0; i < labels->GetNumberOfTuples(); ++i)
  {
    const double label = labels->GetComponent(i, 0);
    EXPECT_TRUE(label >= 0.0 && label <= filter->GetNumberOfRegions()) << "point " << i;
    double sum = 0.0;
    for (int k = 0; k < probabilities->GetNumberOfComponents(); ++k)
    {
      const double u = probabilities->GetComponent(i, k);
      EXPECT_TRUE(u >= 0.0 && u <= 1.0) << "point " << i << ": " << u;
      sum += u;
    }
    largest = std::max(largest, label > 0.0 ? std::abs(sum - 1.0) : 0.0);
  }
  EXPECT_LE(largest, 1e-6);
  EXPECT_GE(filter->GetGap(), 0.0);
  return Text("sum of probabilities to %.1e", largest);
}

inline bool IsWithoutMask(vtkAlgorithm* filter)
{
  vtkInformation* const info = filter->GetInputArrayInformation(1);
  return !info->Has(vtkDataObject::FIELD_NAME());
}

/// Check the promises of an updated filter. The return value describes the findings. solverFailed: whether a
/// warning has said that a linear solver missed its tolerance, which bounds no random field then.
inline std::string ExpectPromises(
  vtkPolyDataAlgorithm* filter, vtkPolyData* input, const char* name, bool solverFailed = false)
{
  vtkDataArray* const u = ResultOf(filter, name);
  auto* const field =
    vtkSurfaceRandomFieldFilter::SafeDownCast(filter); // NaN where nothing is drawn
  const bool mayBeInfinite = vtkSurfaceDistanceFilter::SafeDownCast(filter) || field;
  EXPECT_TRUE(AllFinite(u) || mayBeInfinite);
  if (!u)
  {
    return "no result";
  }
  if (auto* heat = vtkFVMHeatFilter::SafeDownCast(filter))
  {
    const bool hasMissing = heat->GetFidelityWeight() > 0.0 && !IsWithoutMask(heat);
    std::string found = hasMissing ? "" : ExpectTotalIsConserved(heat) + ", ";
    found += ExpectEnergyFalls(heat);
    if (heat->GetIntrinsicDelaunay() &&
      heat->GetTimeIntegrator() == vtkFVMHeatFilter::TIME_INTEGRATOR_FIRST_ORDER)
    {
      found += ", " + ExpectStaysInRange(input->GetPointData()->GetScalars(), u);
    }
    return found;
  }
  if (auto* tv = vtkIntrinsicTVFilter::SafeDownCast(filter))
  {
    const bool isConserving = tv->GetFidelityNorm() == vtkIntrinsicTVFilter::FIDELITY_NORM_L2 &&
      tv->GetColorModel() != vtkIntrinsicTVFilter::COLOR_MODEL_CHROMATICITY_BRIGHTNESS;
    std::string found = isConserving ? ExpectTotalIsConserved(tv) : "";
    if (tv->GetTimeIntegrator() == vtkIntrinsicTVFilter::TIME_INTEGRATOR_FIRST_ORDER &&
      tv->GetMode() == vtkIntrinsicTVFilter::MODE_TIME_STEPS &&
      tv->GetDiscretization() == vtkIntrinsicTVFilter::DISCRETIZATION_LINEAR)
    {
      found += ", " + ExpectEnergyFalls(tv);
    }
    return found;
  }
  if (auto* harmonic = vtkHarmonicMapFilter::SafeDownCast(filter))
  {
    std::string found = ExpectUnitLength(input, u);
    if (harmonic->GetScheme() != vtkHarmonicMapFilter::SCHEME_EXPLICIT_REACTION)
    {
      found += ", " + ExpectEnergyFalls(harmonic);
    }
    return found;
  }
  if (auto* shah = vtkMumfordShahFilter::SafeDownCast(filter))
  {
    vtkDataArray* const edges = ResultOf(shah, "Edges");
    EXPECT_GE(edges->GetRange()[0], 0.0);
    EXPECT_LE(edges->GetRange()[1], 1.0);
    return ExpectTotalIsConserved(shah) + ", " + ExpectEnergyFallsInStages(shah);
  }
  if (auto* tensor = vtkTensorDiffusionFilter::SafeDownCast(filter))
  {
    const bool beltrami = tensor->GetModel() == vtkTensorDiffusionFilter::MODEL_BELTRAMI;
    if (beltrami && tensor->GetMetric() == vtkTensorDiffusionFilter::METRIC_INDUCED)
    {
      return ExpectEnergyFalls(tensor);
    }
    return ExpectTotalIsConserved(tensor) + ", " + ExpectEnergyFalls(tensor);
  }
  if (auto* turing = vtkTuringTextureFilter::SafeDownCast(filter))
  {
    std::string found = ExpectPatternBounds(turing);
    if (turing->GetTimeIntegrator() == vtkTuringTextureFilter::TIME_INTEGRATOR_FIRST_ORDER)
    {
      found += ", " + ExpectReactionBalance(turing, input);
    }
    return found;
  }
  if (auto* segmentation = vtkSurfaceSegmentationFilter::SafeDownCast(filter))
  {
    return ExpectLabelsAndProbabilities(segmentation, u);
  }
  if (auto* spline = vtkSurfaceInterpolationFilter::SafeDownCast(filter))
  {
    // Fewer than three values hold for all settings. A triangle that shares no edge leaves three functions
    // open, and more values may be too few to find a smoothing.
    const bool holds = spline->GetExact() || spline->GetNumberOfValues() < 3;
    const bool may = holds || spline->GetNumberOfValues() < 2 + 3 * input->GetNumberOfCells();
    EXPECT_TRUE(spline->GetEffectiveSmoothing() == 0.0 ? may : !holds);
    return std::to_string(spline->GetNumberOfValues()) + " values, smoothing " +
      std::to_string(spline->GetEffectiveSmoothing());
  }
  if (vtkSurfaceDenoisingFilter::SafeDownCast(filter))
  {
    return ExpectMovedPoints(input, filter->GetOutput(), u);
  }
  if (vtkSurfaceReliefFilter::SafeDownCast(filter))
  {
    return ExpectRelief(input, filter->GetOutput(), u);
  }
  if (vtkSurfaceCurvatureFilter::SafeDownCast(filter))
  {
    return ExpectConsistentCurvatures(filter->GetOutput());
  }
  if (auto* distance = vtkSurfaceDistanceFilter::SafeDownCast(filter))
  {
    const bool isMarched = distance->GetMethod() != vtkSurfaceDistanceFilter::METHOD_HEAT;
    // Of the weights, which are factors then, one may be 0, which counts as 1/1000 of the other.
    const double smallestSpeed = HasInputArray(filter, 11) ? 1e-4 : 1.0;
    return ExpectDistances(
      input, filter->GetOutput(), u, isMarched, distance->GetSigned(), smallestSpeed);
  }
  if (field)
  {
    // Without Normalize, the variance grows where the surface is narrower than the range. Twenty
    // standard deviations are never exceeded.
    double largest = 0.0;
    vtkIdType drawn = 0;
    for (vtkIdType i = 0; i < u->GetNumberOfValues(); ++i)
    {
      const double value = u->GetVariantValue(i).ToDouble();
      EXPECT_FALSE(std::isinf(value));
      drawn += !std::isnan(value);
      largest = std::max(largest, std::isnan(value) ? 0.0 : std::abs(value));
    }
    EXPECT_TRUE(largest < 20.0 || !field->GetNormalize() || solverFailed) << largest;
    EXPECT_TRUE(largest > 0.0 || drawn == 0);
    return "at most " + std::to_string(largest);
  }
  if (vtkSurfaceDerivativesFilter::SafeDownCast(filter))
  {
    double largest = 0.0;
    for (vtkIdType i = 0; i < u->GetNumberOfValues(); ++i)
    {
      EXPECT_FALSE(std::isinf(u->GetVariantValue(i).ToDouble()));
      largest = std::max(largest, std::abs(u->GetVariantValue(i).ToDouble()));
    }
    return "at most " + std::to_string(largest);
  }
  return ExpectTangentialUnitOrZero(input, u);
}

} // namespace FilterTest
