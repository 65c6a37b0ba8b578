// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTensorDiffusionFilter.h"

#include "Run/OwnedSettings.h"
#include "Run/TensorDiffusionSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkTensorDiffusionFilter);

vtkTensorDiffusionFilter::vtkTensorDiffusionFilter()
  : Superclass(OwnedSettings::Make<TensorDiffusionSettings>())
{
}
VTK_ABI_NAMESPACE_END
