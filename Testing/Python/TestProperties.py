# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every property of every class has a setting of its name and type, and every setting that a filter
prints is a property. Enumerators have the numbers of the settings' words."""

import re
import unittest

import vtkSurfaceDiffusion
from vtkmodules.vtkCommonCore import vtkCommand

FILTERS = [cls for name, cls in sorted(vars(vtkSurfaceDiffusion).items())
           if name.startswith("vtk") and name.endswith("Filter") and name != "vtkSurfaceFilter"]

#: Properties without a setting that are not one value each.
OTHERS = {"InputConnection", "InputData", "InputDataObject", "InputArrayToProcess", "Executive",
          "Controller", "Information", "ProgressText", "ProgressObserver", "ProgressShiftScale", "Mean"}


def make(cls):
    """A filter, and the list of its errors."""
    made, errors = cls(), []

    def keep(_, event, text):
        errors.append(text)
    keep.CallDataType = "string0"
    made.AddObserver(vtkCommand.ErrorEvent, keep)
    return made, errors


def properties(cls):
    """The names X of the class and its superclasses here that have SetX() and GetX()."""
    own = set()
    for base in cls.__mro__:
        if base.__module__.startswith(vtkSurfaceDiffusion.__name__):
            own |= set(vars(base))
    return sorted(name[3:] for name in own
                  if name.startswith("Set") and "Get" + name[3:] in own and name[3:] not in OTHERS)


def of_each_property(test):
    """test(self, filter, name) for each property of each class, after which there are no errors."""
    def tests(self):
        self.assertEqual(len(FILTERS), 9)
        for cls in FILTERS:
            for name in properties(cls):
                with self.subTest(cls=cls.__name__, property=name):
                    made, errors = make(cls)
                    test(self, made, name)
                    self.assertEqual(errors, [])
    return tests


class Properties(unittest.TestCase):
    @of_each_property
    def test_have_a_setting_of_their_name_and_type(self, made, name):
        value = getattr(made, "Get" + name)()
        before = made.GetMTime()
        getattr(made, "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
        self.assertEqual(made.GetMTime(), before, "the same value is no change")
        self.assertIn(f"\n  {name}: ", str(made))
        if isinstance(value, (bool, int, float)):
            other = not value if isinstance(value, bool) else value + 1
            getattr(made, "Set" + name)(other)
            self.assertEqual(getattr(made, "Get" + name)(), other)
            self.assertGreater(made.GetMTime(), before)

    @of_each_property
    def test_that_are_switches_can_be_turned_on_and_off(self, made, name):
        if isinstance(getattr(made, "Get" + name)(), bool):
            for value, suffix in ((True, "On"), (False, "Off")):
                getattr(made, name + suffix)()
                self.assertIs(getattr(made, "Get" + name)(), value)

    @of_each_property
    def test_have_enumerators_with_the_numbers_of_their_words(self, made, name):
        setters = [word for word in dir(made) if re.fullmatch(f"Set{name}To[A-Z].*", word)]
        self.assertEqual(len(setters) > 1, hasattr(made, f"Get{name}AsString"))
        for setter in setters:
            word = setter[len(f"Set{name}To"):]
            getattr(made, setter)()
            self.assertEqual(getattr(made, f"Get{name}AsString")(), word)
            numbers = [getattr(made, e) for e in dir(made)
                       if e.isupper() and e.replace("_", "") == (name + word).upper()]
            self.assertEqual(numbers, [getattr(made, "Get" + name)()])

    def test_are_all_the_settings_that_a_filter_prints(self):
        for cls in FILTERS:
            printed = re.findall(r"^  (\w+):", str(cls()), re.MULTILINE)
            self.assertGreater(len(printed), 10)
            for name in printed[printed.index("Debug"):]:
                with self.subTest(cls=cls.__name__, setting=name):
                    self.assertTrue(hasattr(cls, "Get" + name) or name in {
                        "Debug", "Observers", "Executive", "Information", "Means"})


if __name__ == "__main__":
    unittest.main()
