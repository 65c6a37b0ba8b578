# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's window: the toolbar has a button with the icon of each macro, and its buttons run them.

    toolbar.py <folder of the plugins> <folder of the source>

The icons are looked for in the picture of the screen.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

PLUGINS, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
sys.path.insert(0, str(SOURCE / "Examples/ParaView/Screenshots"))
import icons  # noqa: E402
from make import SIZE, read_screen  # noqa: E402

ROWS, COLUMNS = 160, 640  # of the screen, which have the toolbars
SHOWN = 24  # the size of an icon on the screen
PRESS = '<pqevent object="pqClientMainWindow/SurfaceDiffusionMacros/%s" command="activate" arguments=""/>\n'
RUN = ('<pqevent object="pqClientMainWindow/menubar" command="activate" arguments="menu_Macros"/>\n'
       '<pqevent object="pqClientMainWindow/menubar/menu_Macros" command="activate" arguments="%s"/>\n')
REPORT = """
from paraview.simple import *
names = [name for name, _ in GetSources()] + [view.SMProxy.GetXMLName() for view in GetViews()]
open({path!r}, "w").write(" ".join(names))
"""


def picture_of_window(folder, display):
    """Presses two buttons, and returns the names of what is there then and the screen's picture."""
    home = folder / ".config/ParaView/Macros"
    home.mkdir(parents=True)
    (home / "report.py").write_text(REPORT.format(path=str(folder / "names")))
    events = folder / "events.xml"
    events.write_text("<pqevents>\n" + PRESS % "denoise" + PRESS % "history" + RUN % "report" + "</pqevents>\n")
    environment = dict(os.environ, DISPLAY=display, PV_PLUGIN_PATH=str(PLUGINS), HOME=str(folder),
                       XDG_CONFIG_HOME=str(folder / ".config"))
    window = subprocess.Popen(
        ["paraview", "--dr", f"--test-directory={folder}", f"--test-script={events}"],
        env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        for line in window.stdout:
            print(line, end="")
            if "is finished" in line or line.startswith("critical"):
                break
        time.sleep(3)  # until everything is drawn
        return (folder / "names").read_text().split(), read_screen(folder / "Xvfb_screen0")[::-1]
    finally:
        window.kill()
        window.wait()


def place_of(icon, screen):
    """The place of an icon in the upper rows, and its mean difference from the screen there."""
    step = icons.SIZE // SHOWN
    picture = icons.draw(icon)[::-1].astype(float)
    picture = picture.reshape(SHOWN, step, SHOWN, step, 4).mean(axis=(1, 3))
    weights = (picture[..., 3] > 250).astype(float)
    height, width = ROWS - SHOWN, COLUMNS - SHOWN
    error, screen = np.zeros((height, width), np.float32), screen.astype(np.float32)
    for y, x in zip(*weights.nonzero()):
        error += np.abs(screen[y:y + height, x:x + width] - picture[y, x, :3]).mean(axis=2)
    error /= weights.sum()
    best = np.unravel_index(error.argmin(), error.shape)
    return best, error[best]


def main():
    display = ":%d" % (1000 + os.getpid() % 8000)
    with tempfile.TemporaryDirectory() as name:
        server = subprocess.Popen(["Xvfb", display, "-screen", "0", "%dx%dx24" % SIZE, "-noreset", "-fbdir", name])
        try:
            time.sleep(2)
            names, screen = picture_of_window(pathlib.Path(name), display)
        finally:
            server.terminate()
            server.wait()
    print("sources and views:", *names)
    assert "Denoised" in names and "XYChartView" in names, names
    macros = sorted(path.stem for path in (SOURCE / "Examples/ParaView/Macros").glob("*.py"))
    drawn = {icon.__name__: icon for icon in icons.ICONS}
    assert sorted(drawn) == macros, (sorted(drawn), macros)
    places = []
    for macro in macros:
        place, error = place_of(drawn[macro], screen)
        print(f"{macro}: at {place}, difference {error:.1f} of 255")
        assert error < 16, macro
        places.append(place)
    assert len({y for y, _ in places}) == 1 and sorted(x for _, x in places) == [x for _, x in places]
    upside_down, error = place_of(lambda x, y: drawn["denoise"](x, -y), screen)
    assert error > 30, (upside_down, error)


if __name__ == "__main__":
    main()
