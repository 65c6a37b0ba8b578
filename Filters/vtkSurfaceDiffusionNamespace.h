// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK_ABI_NAMESPACE_BEGIN and VTK_ABI_NAMESPACE_END, the namespace that a build of VTK may give its
// classes. VTK 9.1 has none.
#ifndef vtkSurfaceDiffusionNamespace_h
#define vtkSurfaceDiffusionNamespace_h

#include "vtkType.h" // includes vtkABINamespace.h where there is one

#ifndef VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_BEGIN
#define VTK_ABI_NAMESPACE_END
#endif

#endif
