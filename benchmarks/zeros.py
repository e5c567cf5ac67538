# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/zeros.py [--most-faces N] [FILE ...]

The sum of the orders of the zeros of ten random combinations of forms, without and with two poles, on every surface of
genus >= 2 among the meshes, by default those of ../shared/meshes. On a surface with boundary: the orders on it and
twice the others, which are those on the double.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MESHES = ROOT.parent / "shared" / "meshes"
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support")]

import holomorph  # noqa: E402
from zero_sums import COMBINATIONS, rows  # noqa: E402

MESH_TYPES = (".obj", ".off", ".ply", ".stl", ".ply.gz")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most-faces", type=int, default=10**7)
    parser.add_argument("files", type=Path, nargs="*")
    options = parser.parse_args()
    paths = options.files or sorted(path for path in MESHES.iterdir() if path.name.endswith(MESH_TYPES))
    print(f"{'mesh':36} {'genus':>5} {'loops':>5} {'poles':>5} {'sum':>5}  right of {COMBINATIONS}")
    for path in paths:
        try:
            for genus, loops, count, right, found in rows(path, options.most_faces):
                print(f"{path.name:36} {genus:5} {loops:5} {count:5} {right:5}  {found.count(right)}", flush=True)
        except holomorph.Error as error:
            print(f"{path.name:36} {error}")


if __name__ == "__main__":
    main()
