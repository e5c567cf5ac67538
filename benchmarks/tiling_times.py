# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/tiling_times.py [--most-faces N] [FILE ...]

How many times longer a tiling with automatic poles takes than the conformal structure of the same surface, by genus,
boundary loops and size: on blocks and plates with rectangular holes, and on the meshes given. Each is measured once,
structure and tiling in turn, in processor time, which other work on the machine changes least. Ratios alone, as seconds
do not carry over to other machines; those of small surfaces have a star where the tiling takes less than ten seconds,
which nobody would shorten for a ratio.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support")]

import families  # noqa: E402
import holomorph  # noqa: E402

SHORT = 10.0  # seconds
# Holes in two directions, and squares along each side of a hole: a block has as many handles, a plate as many loops.
BLOCKS = [(0, 0, 12), (0, 0, 80), (1, 1, 4), (1, 1, 40), (3, 3, 2), (3, 3, 12), (5, 8, 1), (5, 8, 6), (10, 14, 1)]
BLOCKS += [(10, 14, 3), (16, 16, 1), (15, 20, 1), (15, 20, 4), (1, 1, 176)]
PLATES = [(1, 1, 20), (4, 8, 2), (4, 8, 10), (10, 10, 2), (10, 10, 12)]


def cells(across, along, scale):
    """(n, m) bool: a grid of holes."""
    solid = np.ones((2 * across + 1, 2 * along + 1), bool)
    solid[1::2, 1::2] = False
    return np.kron(solid, np.ones((scale, scale), bool))


def surface(mesh):
    return holomorph.Surface(mesh.vertices, np.split(mesh.corners, mesh.offsets[1:-1]))


def cases(files):
    """Yields (name, surface)."""
    for size in BLOCKS:
        yield f"block {size}", surface(families.voxel_surface(cells(*size)[:, :, None]))
    for size in PLATES:
        yield f"plate {size}", surface(families.flat_cells(cells(*size), 1.0))
    for path in files:
        for i, component in enumerate(holomorph.Surface.read(path).components):
            yield f"{path.name} {i}", component


def seconds(work):
    """(what it gives, how long it took)."""
    start = time.process_time()
    result = work()
    return result, time.process_time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most-faces", type=int, default=10**6)
    parser.add_argument("files", type=Path, nargs="*")
    options = parser.parse_args()
    columns = ("faces", "genus", "loops", "poles", "integers", "blocks", "added", "ratio", "evened")
    print(f"{'surface':28}" + "".join(f"{name:>10}" for name in columns))
    for name, given in cases(options.files):
        if len(given.triangles) > options.most_faces:
            continue
        _, alone = seconds(lambda: holomorph.automatic_structure(given))  # noqa: B023
        row = []
        for evenness in (0.0, 0.5):
            make = lambda: holomorph.Tiler(given, evened=evenness > 0).tile(evenness=evenness)  # noqa: B023, E731
            try:
                tiling, whole = seconds(make)
            except holomorph.TopologyError as error:
                row.append(str(error)[:40])
                continue
            row.append(f"{whole / alone:.1f}{'*' if whole < SHORT else ''}")
        found = tiling.rounding
        facts = (len(given.triangles), given.genus, given.boundary_count, len(tiling.poles), found.integers)
        facts += (found.blocks, f"{tiling.added_distortion:.3f}", *row)
        print(f"{name:28}" + "".join(f"{fact:>10}" for fact in facts), flush=True)


if __name__ == "__main__":
    main()
