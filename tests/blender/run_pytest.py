"""Run pytest inside a Blender program and leave with pytest's exit code.

    blender -b --factory-startup --python-exit-code 9 --python tests/blender/run_pytest.py -- -q tests/blender

HOLOMORPH_TEST_PYTHONPATH lists folders to import from, such as the one that pytest is in: some Blenders ignore
PYTHONPATH.
"""

import os
import sys

sys.path[:0] = [path for path in os.environ.get("HOLOMORPH_TEST_PYTHONPATH", "").split(os.pathsep) if path]

import pytest  # noqa: E402  (found on the path above)

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
code = pytest.main(arguments)
sys.stdout.flush()
sys.stderr.flush()
os._exit(int(code))  # no exit handlers: Blender would turn the code into its own
