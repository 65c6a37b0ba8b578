// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MacroToolbar_h
#define MacroToolbar_h

/// Adds a toolbar to ParaView's window, with a button for each macro of Examples/ParaView/Macros. The
/// plugin holds macros and icons, so that nothing has to be imported. Without a window it does nothing.
void addMacroToolbar();

#endif
