# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the native package ``holomorph``, or says in one sentence what is missing.

It is installed as a wheel (an extension, or pip), or lies in a folder that `folders` knows: in the zip for Blender
before 4.2, or in a checkout. Neither NumPy nor ``holomorph`` is imported at registration: the panel must draw without
them.
"""

import functools
import importlib
import platform
import sys

from . import addresses

NAME = "holomorph"
# What the name of a zip says of the computer it is for, by what Python says of it.
PLATFORMS = {
    ("Windows", "AMD64"): "windows_x64",
    ("Darwin", "arm64"): "macos_arm64",
    ("Darwin", "x86_64"): "macos_x64",
    ("Linux", "x86_64"): "linux_x64",
    ("Linux", "aarch64"): "linux_arm64",
}
TAGS = ("cp311", "cp313", "cp314")  # the Pythons that the zips have modules for
FIRST_WITH_EXTENSIONS = (4, 2)  # version of Blender


class NativeMissing(Exception):
    """The native part cannot be used; the text is one sentence for the user."""


def python_tag():
    """The tag of this interpreter's builds, for example ``cp311``."""
    return f"cp{sys.version_info[0]}{sys.version_info[1]}"


def _looked_for():
    return f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"


def right_zip(blender, system, machine, tag):
    """What to install in that version of Blender: the end of a sentence."""
    platform_name = PLATFORMS.get((system, machine))
    if platform_name is None or tag not in TAGS:
        return "no zip exists for this computer: compile the add-on on it with scripts/build"
    end = platform_name if blender >= FIRST_WITH_EXTENSIONS else "blender-3.4"
    if end == platform_name or (platform_name, tag) == ("linux_x64", "cp311"):
        place = f" at {addresses.DOWNLOAD}" if addresses.DOWNLOAD else ""
        return f"the zip to install in this Blender is the one{place} whose name ends in {end}.zip"
    return "on this computer it needs Blender 4.2 or newer"


def _right_zip_here():
    import bpy  # here alone: the package is also looked for where there is no Blender

    return right_zip(bpy.app.version, platform.system(), platform.machine(), python_tag())


def _find():
    if __package__ == NAME:
        raise NativeMissing(f"The add-on's own folder must not be called {NAME!r}, the name of its native package")
    other = ""
    try:
        found = importlib.import_module(NAME)
        if hasattr(found, "conformal_structure"):
            return found
        other = f"; another module is called {NAME}: {getattr(found, '__path__', found)}"
    except ModuleNotFoundError as error:
        if error.name not in (NAME, f"{NAME}._native"):
            raise
    found = _beside()
    if found is None:
        raise NativeMissing(f"Holomorph's native part for {_looked_for()} is not installed: {_right_zip_here()}{other}")
    return found


def _beside():
    """The package in a folder; None in an extension, which has it as a wheel."""
    try:
        from . import folders
    except ImportError:
        return None
    return folders.find(NAME, python_tag())


@functools.lru_cache(maxsize=1)
def _load():
    try:
        importlib.import_module("numpy")
    except ImportError:
        return None, f"Holomorph needs NumPy, which this Blender's {_looked_for()} does not have"
    try:
        return _find(), ""
    except NativeMissing as error:
        return None, str(error)
    except ImportError as error:
        return (
            None,
            f"Holomorph's native part does not load with {_looked_for()}: {sentence(error)}; {_right_zip_here()}",
        )


def problem():
    """One sentence saying why the native part cannot be used, or an empty string."""
    return _load()[1]


def load():
    """The module ``holomorph``; raises `NativeMissing`."""
    module, reason = _load()
    if module is None:
        raise NativeMissing(reason)
    return module


def forget():
    """Looks again at the next call (after an installation, or at registration)."""
    _load.cache_clear()
    vars(holomorph).clear()


class _Library:
    """The package, which is loaded when something of it is needed; modules that NumPy may be loaded with import it."""

    def __getattr__(self, name):
        package = load()
        vars(self).update(vars(package))  # the next time Python itself finds what there is
        return getattr(package, name)


holomorph = _Library()


def module(name):
    """A module of the package that importing the package does not import."""
    return importlib.import_module(f"{load().__name__}.{name}")


def fault(error):
    """The sentence about an error that nothing foresaw, with a report to send."""
    return module("core.unexpected").told(error)


def sentence(error):
    """The message of an exception, on one line."""
    return " ".join(str(error).split()) or type(error).__name__
