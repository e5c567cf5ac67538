"""Run by its path, `python -P .../holomorph/batch/start.py`: a worker of the package that this file lies in. Nothing is
imported from the current folder, where assets may lie, nor from this one."""

import importlib.util
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]

if PACKAGE.name not in sys.modules:  # under its own name, wherever else another one is
    spec = importlib.util.spec_from_file_location(PACKAGE.name, PACKAGE / "__init__.py")
    sys.modules[PACKAGE.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE.name])
importlib.import_module(f"{PACKAGE.name}.batch.workers").main()
