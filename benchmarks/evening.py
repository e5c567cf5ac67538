# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/evening.py [--iterations N] [--json FILE] [MESH ...]

Evenness against shear, beside SLIM of libigl (Rabinovich et al. 2017, doi:10.1145/2983621), on closed surfaces, by
default four of ../shared/meshes. Three families of maps on the same triangles:

seamless   the tiling with automatic poles, evened: jumps across the cut stay whole tiles
torn       the conformal map of the same cut with a free boundary, evened with the same energy
SLIM       from that conformal map; exponential energies from the first of these maps, as they get nowhere else; and
           from the tiling at evenness 0.5: all free at the cut

Then 95:5 of the first two over SLIM's, each at SLIM's mean s1/s2, which is capped at 10 in a triangle. Without libigl
there is no SLIM.
"""

import argparse
import importlib.util
import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
MESHES = ROOT.parent / "shared" / "meshes"
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path.insert(0, str(PACKAGE))

import holomorph  # noqa: E402
from holomorph.mesh.surgery import cut_open  # noqa: E402
from holomorph.quality.quality import Quality  # noqa: E402

DEFAULT = ("kitten_19k.obj", "fertility_ngon_g4.obj", "armadillo_29k.obj", "spot_quads.obj")
EVENNESS = (0.0, 0.25, 0.5, 0.75, 1.0)
USUAL = 0.5  # whose time the others are compared with
PLAIN, EXPONENTIAL = ("SYMMETRIC_DIRICHLET", "LOG_ARAP"), ("EXP_SYMMETRIC_DIRICHLET", "EXP_CONFORMAL")
WHOLE = 1e-9  # tiles, how far a jump may be from whole ones


@dataclass
class Row:
    """A map: quantiles of the density by area, seams over the diagonal of the bounding box, seconds."""

    family: str
    name: str
    ratio: float
    extreme: float
    shear: float
    flipped: float
    seams: float
    seconds: float


class Case:
    """A surface, its tiling with automatic poles, and the surface cut along it."""

    def __init__(self, path):
        given = holomorph.Surface.read(path)
        self.tiler = holomorph.Tiler(given, evened=True)
        self.conformal = self.tiler.tile()
        native = self.conformal.quality._triangulation
        self.corners = native.triangle_corners
        self.surface = holomorph.Surface(given.vertices, native.corner_vertices[self.corners])
        self.cut = cut_open(self.surface, self._is_seam(self.conformal.seams))
        if (self.cut.euler_characteristic, self.cut.boundary_count) != (1, 1):
            raise holomorph.TopologyError("the cut surface is not a disk")
        self.scale = self.conformal.quality.median_density**-0.5  # so that the median density is 1

    def _is_seam(self, pairs):
        count = len(self.surface.vertices)
        key = [np.sort(ends, axis=1).astype(np.int64) @ [count, 1] for ends in (self.surface._native.edges, pairs)]
        return np.isin(*key)

    def tiling(self, evenness):
        """(#T, 3, 2) UVs, in tiles."""
        return self.tiler.even(self.conformal, evenness).uv[self.corners]

    def on_cut(self, uv):
        """(#V, 2) of the cut surface: the mean of the corners, which differ at poles alone."""
        vertices, count = self.cut.triangles.ravel(), len(self.cut.vertices)
        sums = [np.bincount(vertices, each, count) for each in uv.reshape(-1, 2).T]
        return np.transpose(sums) / np.bincount(vertices, minlength=count)[:, None]

    def row(self, family, name, make):
        begin = time.perf_counter()
        uv = make()
        seconds = time.perf_counter() - begin
        quality = Quality.of(self.surface._native, uv.reshape(-1, 2), 0)
        shares = (0.01, 0.05, 0.95, 0.99)
        low, few, most, high = np.quantile(quality.area, shares, weights=quality.weights, method="inverted_cdf")
        seams = self._seam_length(uv if family == "seamless" else uv / self.scale)
        shear, flipped = quality.mean_angle, quality.flipped_part
        return Row(family, name, most / few, high / low, shear, flipped, seams, seconds)

    def _seam_length(self, uv):
        """That of the edges across which UVs do not jump by whole tiles, over the diagonal of the bounding box."""
        edges = self.surface._native.triangle_edges.ravel()
        one, other = np.argsort(edges, kind="stable").reshape(-1, 2).T
        start, end = uv.reshape(-1, 2), np.roll(uv, -1, axis=1).reshape(-1, 2)
        jumps = np.stack([start[one] - end[other], end[one] - start[other]])
        is_seam = (np.abs(jumps - np.rint(jumps)) > WHOLE * np.abs(uv).max()).any(axis=(0, 2))
        length = self.surface._native.edge_lengths[edges[one]][is_seam].sum()
        return float(length / np.linalg.norm(np.ptp(self.surface.vertices, axis=0)))


def evened(surface, uv, evenness):
    """(#C, 2) UVs of a disk with a free boundary, evened."""
    options = {"poles": [], "u": [], "v": [], "solver": "auto", "threads": os.cpu_count(), "progress": None}
    return uv + holomorph._native.evened(surface, uv, evenness=evenness, **options)[surface.corner_vertices]


def slim(case, start, energy, iterations):
    import igl

    none = np.zeros(0, np.int32), np.zeros((0, 2), order="F")
    mesh = np.asfortranarray(case.cut.vertices), np.asfortranarray(case.cut.triangles, np.int32)
    data = igl.slim_precompute(*mesh, np.asfortranarray(start), getattr(igl.MappingEnergyType, energy), *none, 0.0)
    return igl.slim_solve(data, iterations)[case.cut.triangles]


def measured(case, iterations):
    rows = [case.row("seamless", f"evenness {e}", lambda e=e: case.tiling(e)) for e in EVENNESS]
    free = holomorph.free_boundary_map(case.cut).uv()
    free = free * Quality.of(case.cut._native, free, 0).median_density ** -0.5
    corners = case.cut.triangle_corners
    for e in EVENNESS:
        rows.append(case.row("torn", f"evenness {e}", lambda e=e: evened(case.cut._native, free, e)[corners]))
    if importlib.util.find_spec("igl") is None:
        return rows
    return rows + slim_rows(case, case.on_cut(free[corners]), iterations)


def slim_rows(case, conformal, iterations):
    tiling = case.on_cut(case.tiling(USUAL) * case.scale)
    plain = slim(case, conformal, PLAIN[0], iterations)
    starts = [(name, name, conformal) for name in PLAIN]
    starts += [(name, name, case.on_cut(plain)) for name in EXPONENTIAL]
    starts += [(f"{PLAIN[0]}, tiling", PLAIN[0], tiling)]
    return [
        case.row("SLIM", name, lambda energy=energy, start=start: slim(case, start, energy, iterations))
        for name, energy, start in starts
    ]


def at_equal_shear(rows, family, other):
    """("", "<=" or ">=", 95:5 of the family over that of the other map), where 95:5 is interpolated to the shear of
    that map; outside the family's, its nearest map bounds it."""
    front = sorted((row.shear, np.log(row.ratio)) for row in rows if row.family == family)
    shears, logs = np.transpose(front)
    sign = ">=" if other.shear < shears[0] else "<=" if other.shear > shears[-1] else ""
    return sign, float(np.exp(np.interp(other.shear, shears, logs)) / other.ratio)


def show(name, case, rows):
    print(f"\n{name}: {len(case.surface.triangles)} triangles, {len(case.conformal.poles)} poles")
    heads = f"{'95:5':>6} {'99:1':>6} {'s1/s2':>6} {'flipped':>8} {'seams':>6} {'time':>6} {'seamless':>9} {'torn':>7}"
    print(36 * " ", heads)
    usual = rows[EVENNESS.index(USUAL)].seconds
    for row in rows:
        figures = f"{row.ratio:6.2f} {row.extreme:6.1f} {row.shear:6.3f} {row.flipped:8.1e} {row.seams:6.2f}"
        line = f"{row.family:9} {row.name:26} {figures} {row.seconds / usual:6.1f}"
        if row.family == "SLIM":
            for family, width in (("seamless", 9), ("torn", 7)):
                sign, ratio = at_equal_shear(rows, family, row)
                line += f" {f'{sign} {ratio:.2f}':>{width}}"
        print(line, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--iterations", type=int, default=50, help="steps of SLIM")
    parser.add_argument("--json", type=Path)
    parser.add_argument("meshes", type=Path, nargs="*")
    options = parser.parse_args()
    print("time: over that of the tiling at evenness 0.5; last columns: 95:5 over SLIM's at SLIM's mean s1/s2")
    found = {}
    for path in options.meshes or [MESHES / name for name in DEFAULT]:
        if not path.exists():
            print(f"\n{path.name}: not there")
            continue
        case = Case(path)
        rows = measured(case, options.iterations)
        show(path.name, case, rows)
        found[path.name] = [vars(row) for row in rows]
    if options.json:
        options.json.write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
