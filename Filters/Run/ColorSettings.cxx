// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/ColorSettings.h"

namespace SurfaceDiffusion
{

void ColorSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice(
    { "ColorModel", "",
      "The unknowns of three-component data. RGB: the components. Opponent: brightness "
      "and two orthonormal axes of colour, with ChromaWeight. ChromaticityBrightness: "
      "u = B C with the brightness B = |u| and the chromaticity C, a unit vector." },
    this->Model, { "RGB", "Opponent", "ChromaticityBrightness" });
  visitor.Number(
    { "ChromaWeight", "",
      "The factor of FidelityWeight on the two axes of colour of Opponent; below 1 they "
      "are smoothed more than brightness." },
    this->ChromaWeight, SettingRange::Positive());
  visitor.Number(
    { "ChromaticityExponent", "",
      "p of the energy mu/p int |grad C|^p of ChromaticityBrightness: 1 keeps edges of "
      "hue, 2 smooths evenly." },
    this->ChromaticityExponent, SettingRange::Between(1.0, 2.0, "numbers from 1 to 2"));
  visitor.Number({ "ChromaticityWeight", "R",
                   "mu of ChromaticityBrightness, the weight of the smoothness of C beside that of "
                   "B." },
    this->ChromaticityWeight, SettingRange::Positive());
  visitor.Switch({ "LinearLight", "",
                   "Whether unsigned char colours are decoded from sRGB to linear light and the "
                   "result is encoded, with Opponent and ChromaticityBrightness. Off suits noise "
                   "of equal strength in the bytes." },
    this->LinearLight);
}

} // namespace SurfaceDiffusion
