# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole job from the command line, without a window:

blender -b --disable-autoexec [file.blend] --python-exit-code 1 --python addon/headless.py -- [mesh file] --output ...

Ends with 0 if some component got its maps, otherwise with 1 and one sentence on the error stream; with --strict also
with 3 and one sentence, everything written, where a part was left out or the verdict on a map is poor or unusable; at
Ctrl-C with 130, what is written being whole. Scripts in a .blend file do not run with --disable-autoexec.
"""

import importlib.util
import sys
from pathlib import Path

PACKAGE = "holomorph_headless"  # the name under which this script loads the add-on that it lies in


def module(name):
    """One of the add-on's modules, whether or not the add-on is installed and enabled in this Blender."""
    if PACKAGE not in sys.modules:
        folder = Path(__file__).resolve().parent
        spec = importlib.util.spec_from_file_location(
            PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[PACKAGE])
    return importlib.import_module(f"{PACKAGE}.{name}")


if __name__ == "__main__":
    module("command_line.command").main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
