// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/ColorSettings.h"

namespace SurfaceDiffusion
{

void ColorSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "ColorModel", "",
                   "The unknowns of colours, which are data of three components (alpha not "
                   "counted). RGB: the components. Opponent: brightness and two orthonormal axes "
                   "of colour, which have a fidelity weight of their own. "
                   "ChromaticityBrightness: the length of the vector of the components by "
                   "EdgeFunction, and its direction by a harmonic map; it restores colours whose "
                   "hue is noisy. Both need FidelityNorm L2 and no BlurFWHM.",
                   "(FidelityNorm=L2 and BlurFWHM=0) or ColorModel!=RGB" },
    this->Model, { "RGB", "Opponent", "ChromaticityBrightness" });
  visitor.Number({ "ChromaWeight", "",
                   "The factor of the fidelity weight on the two axes of colour of ColorModel "
                   "Opponent, above 0. Below 1, colour is smoothed more than brightness.",
                   "ColorModel=Opponent" },
    this->ChromaWeight, SettingRange::Positive());
  visitor.Number({ "ChromaticityExponent", "",
                   "The power of the gradient in the energy of the direction of colours, from 1, "
                   "which keeps edges of hue, to 2, which smooths evenly.",
                   "ColorModel=ChromaticityBrightness" },
    this->ChromaticityExponent, SettingRange::Between(1.0, 2.0, "numbers from 1 to 2"));
  visitor.Number({ "ChromaticityWeight", "R",
                   "The weight of the smoothness of the direction of colours beside that of "
                   "their length, above 0, in R. A larger weight smooths hue more.",
                   "ColorModel=ChromaticityBrightness" },
    this->ChromaticityWeight, SettingRange::Positive());
  visitor.Switch({ "LinearLight", "",
                   "Decode unsigned char colours from sRGB to linear light, and encode the "
                   "result. Results below 0 and above 255 become 0 and 255. It has no effect on "
                   "data of other types, nor with the ColorModel RGB. Noise is usually of equal "
                   "strength in the bytes: off then gives the better result.",
                   "ColorModel!=RGB" },
    this->LinearLight);
}

} // namespace SurfaceDiffusion
