// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The unknowns that colours are described by.
enum class ColorModel
{
  RGB, ///< the components of the data
  Opponent, ///< brightness and two axes of colour, see OpponentColors
  ChromaticityBrightness ///< length and direction, see the class of this name
};

/// The settings of models of colours.
struct ColorSettings
{
  ColorModel Model = ColorModel::RGB;
  double ChromaWeight = 0.2; ///< of Opponent
  double ChromaticityExponent = 1.0; ///< p
  double ChromaticityWeight = 1.0; ///< mu
  bool LinearLight = false;

  void Visit(SettingVisitor& visitor);

  bool IsRGB() const { return this->Model == ColorModel::RGB; }
  bool UsesLinearLight() const { return this->LinearLight && !this->IsRGB(); }

  /// The factors of lambda in the columns of the unknowns; empty: 1 everywhere.
  std::vector<double> ChannelWeights() const
  {
    return this->Model == ColorModel::Opponent && this->ChromaWeight != 1.0
      ? std::vector<double>{ 1.0, this->ChromaWeight, this->ChromaWeight }
      : std::vector<double>();
  }
};

} // namespace SurfaceDiffusion
