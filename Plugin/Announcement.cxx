// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// When ParaView loads this plugin after the one in Python, its proxies replace those of the same
// names. A line says so; the plugin in Python, loaded after this one, leaves them alone.

#include "vtkOutputWindow.h"
#include "vtkPVPluginTracker.h"

#include <string>

namespace
{

struct Announcement
{
  Announcement()
  {
    vtkPVPluginTracker* const tracker = vtkPVPluginTracker::GetInstance();
    for (unsigned int p = 0; p < tracker->GetNumberOfPlugins(); ++p)
    {
      const char* const name = tracker->GetPluginName(p);
      if (name && std::string(name) == "SurfaceDiffusionPython" && tracker->GetPluginLoaded(p))
      {
        vtkOutputWindowDisplayText("SurfaceDiffusion: the plugin SurfaceDiffusionPython is loaded, "
                                   "too. New filters are those "
                                   "of SurfaceDiffusion; those made before stay.\n");
      }
    }
  }
};

const Announcement WhenLoaded;

} // namespace
