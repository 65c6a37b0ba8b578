// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Assert that an enumerator of a VTK class has the number of the enumerator of Core or Run that it
/// stands for: values are cast from one to the other.
#define SURFACEDIFFUSION_MIRROR(vtkEnumerator, enumerator)                                         \
  static_assert(static_cast<int>(vtkEnumerator) == static_cast<int>(enumerator),                   \
    #vtkEnumerator " must have the number of " #enumerator)
