# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled programs of the benchmarks."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build" / "cmake" / "benchmarks"


def program(name):
    """The path of benchmarks/<name>.cpp, compiled as the library is."""
    pybind11 = subprocess.run(
        [sys.executable, "-m", "pybind11", "--cmakedir"], capture_output=True, text=True, check=True
    )
    options = [f"-DPython_EXECUTABLE={sys.executable}", f"-Dpybind11_DIR={pybind11.stdout.strip()}"]
    configure = ["cmake", "-S", ROOT, "--preset", "release", "-B", BUILD, "-DHOLOMORPH_BENCHMARKS=ON", *options]
    subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", BUILD, "--target", name, "--", "--quiet"], check=True)
    return BUILD / "benchmarks" / name
