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
SIZES = range(22, 30)  # of an icon on the screen, which depends on the style of Qt
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


def place_of(icon, screen, size):
    """The place of an icon in the toolbars, and its mean difference from the screen there."""
    picture = icons.draw(icon, size)[::-1].astype(np.float32)
    height, width = ROWS - size, COLUMNS - size
    error, count = np.zeros((height, width), np.float32), 0
    for y, x in zip(*(picture[..., 3] > 250).nonzero()):
        error += np.abs(screen[y:y + height, x:x + width] - picture[y, x, :3]).mean(axis=2)
        count += 1
    place = np.unravel_index(error.argmin(), error.shape)
    return place, error[place] / count


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
    screen, places = screen.astype(np.float32), []
    size = min(SIZES, key=lambda size: place_of(icons.edges, screen, size)[1])
    print("size of the icons:", size)
    for macro in macros:
        place, error = place_of(drawn[macro], screen, size)
        print(f"{macro}: at {place}, difference {error:.1f} of 255")
        assert error < 8, macro
        places.append(place)
    assert np.ptp([y for y, _ in places]) <= 1, places
    assert all(np.diff([x for _, x in places]) > size / 2), places
    _, error = place_of(lambda x, y: icons.edges(x, -y), screen, size)  # which is not there
    print(f"upside down: difference {error:.1f} of 255")
    assert error > 24


if __name__ == "__main__":
    main()
