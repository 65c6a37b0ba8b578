# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Headless Chromium for tests, and checks of its pictures."""
import io
import shutil
import sys
import time

try:
    import numpy as np
    from PIL import Image
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError as problem:
    print(f"skipped: {problem} (.ci/fetch-test-data brings it)")
    sys.exit(77)

for program in ("chromium", "chromedriver"):
    if not shutil.which(program):
        print(f"skipped: {program} is not installed (.ci/install-packages brings it)")
        sys.exit(77)

PATIENCE = 180  # seconds; two cores may be busy with other tests


def open_browser(downloads=None, performance=False):
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--window-size=1200,800"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {
        "browser": "ALL", **({"performance": "ALL"} if performance else {})})
    if downloads:
        options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
    return webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))


def wait_for(condition, what, seconds=PATIENCE):
    """The first true result of condition(); of an array, one that is not zero."""
    end = time.monotonic() + seconds
    while True:
        try:
            result = condition()
        except Exception as problem:  # an element that is being replaced
            result, last = None, problem
        else:
            last = result
        if np.any(result):
            return result
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds} s: {what}; last: {last!r}")
        time.sleep(0.1)  # pictures of the page take time, too


def picture_in(png):
    """An array (height, width, 3) of int."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def picture_of(browser):
    """The page as an array (height, width, 3) of int."""
    return picture_in(browser.get_screenshot_as_png())


def difference(first, second):
    """The part of the pixels that differ visibly."""
    return float((np.abs(first - second).max(axis=2) > 24).mean())


def drag(browser, element, right, down, at=(0, 0)):
    """Drag the mouse over an element, from `at` pixels beside its middle."""
    actions = ActionChains(browser, duration=50)
    actions.move_to_element_with_offset(element, *at).click_and_hold()
    for _ in range(4):
        actions.move_by_offset(right // 4, down // 4)
    actions.release().perform()
