// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace SurfaceDiffusion
{

/// Powers of length and value in a physical dimension.
struct Dimension
{
  double Length = 0.0;
  double Value = 0.0;
};

/// Conversion between the user's units and the units of the numerics, which measure lengths in
/// LengthUnit and values in ValueUnit, both powers of two. Natural units measure lengths in the
/// mean edge length h and values in the range R.
struct UnitSystem
{
  bool Natural = true;
  double MeanEdgeLength = 1.0; ///< h, in coordinate units
  double Area = 1.0; ///< of a connected component, the mean by area, in coordinate units
  double ValueRange = 1.0; ///< R, in the array's units
  double LengthUnit = 1.0; ///< of the mesh of the numerics, in coordinate units
  double ValueUnit = 1.0; ///< of the values of the numerics, in the array's units

  /// A user's quantity of dimension length^lengthPower value^valuePower in units of the numerics.
  double ToCore(double quantity, double lengthPower, double valuePower) const
  {
    const double length = (this->Natural ? this->MeanEdgeLength : 1.0) / this->LengthUnit;
    const double value = (this->Natural ? this->ValueRange : 1.0) / this->ValueUnit;
    return quantity * std::pow(length, lengthPower) * std::pow(value, valuePower);
  }
  double ToCore(double quantity, const Dimension& dimension) const
  {
    return this->ToCore(quantity, dimension.Length, dimension.Value);
  }

  /// A quantity of the numerics in coordinate and array units.
  double FromCore(double quantity, double lengthPower, double valuePower) const
  {
    return quantity * std::pow(this->LengthUnit, lengthPower) *
      std::pow(this->ValueUnit, valuePower);
  }

  /// h and R in units of the numerics.
  double CoreEdgeLength() const { return this->MeanEdgeLength / this->LengthUnit; }
  double CoreValueRange() const { return this->ValueRange / this->ValueUnit; }

  friend bool operator==(const UnitSystem& a, const UnitSystem& b)
  {
    return a.Natural == b.Natural && a.MeanEdgeLength == b.MeanEdgeLength && a.Area == b.Area &&
      a.ValueRange == b.ValueRange && a.LengthUnit == b.LengthUnit && a.ValueUnit == b.ValueUnit;
  }
};

} // namespace SurfaceDiffusion
