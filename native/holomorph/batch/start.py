"""Run by its path, `python -P .../holomorph/batch/start.py`: a worker of the package that this file lies in. Nothing is
imported from the current folder, where assets may lie, nor from this one."""

import importlib
import importlib.util
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]


def package():
    """The package, under its own name, wherever else another one is."""
    loaded = sys.modules.get(PACKAGE.name)
    if loaded is not None and Path(loaded.__file__).resolve().parent == PACKAGE:
        return
    spec = importlib.util.spec_from_file_location(
        PACKAGE.name, PACKAGE / "__init__.py", submodule_search_locations=[str(PACKAGE)]
    )
    sys.modules[PACKAGE.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE.name])


package()
importlib.import_module(f"{PACKAGE.name}.batch.worker").main()
