"""The command in a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

import holomorph


def run(*arguments):
    package = str(Path(holomorph.__file__).parents[1])
    return subprocess.run(
        [sys.executable, "-m", "holomorph", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"PYTHONPATH": package},
    )
