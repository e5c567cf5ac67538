# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/seamless_maps.py DIRECTIONAL [MESH ...] [--tiles N] [--ceps PROGRAM]

Maps that turn by quarters beside other methods for surfaces of any genus, on closed meshes, by default five of
../shared/meshes. DIRECTIONAL is a checkout of https://github.com/avaxman/Directional, which is compiled; PROGRAM is
`parameterize` of https://github.com/MarkGillespie/CEPS, and goes on until no cone or square is e times another's size.
Ours have the density of Directional's: without a wanted direction, as its are, at evenness 0.5 and 0.9, then upright.

Prints 95:5 of the density's root; mean s1/s2; what part of the steep area is upright; flipped triangles; the length of
the edges where the texture does not continue by a quarter turn and whole tiles, over the diagonal of the bounding box;
seconds of processor.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
MESHES = ROOT.parent / "shared" / "meshes"
PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path.insert(0, str(PACKAGE))

import holomorph  # noqa: E402

DEFAULT = ("hand_closed.obj", "kitten_19k.obj", "spot_quads.obj", "bob_small.ply", "fertility_ngon_g4.obj")
OURS = ((None, 0.5), (None, 0.9), ("upright", 0.5))  # direction, evenness
CEPS_SCALE = 1.0  # the largest logarithm of a scale factor for which CEPS places no further cone
TORN = 1e-4  # tiles


def compiled(checkout, folder):
    """The path of directional_map.cpp's program."""
    eigen = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True)
    program, include = folder / "directional_map", f"-I{checkout / 'include'}"
    source = ROOT / "benchmarks" / "directional_map.cpp"
    subprocess.run(["c++", "-std=c++20", "-O2", include, *eigen.stdout.split(), source, "-o", program], check=True)
    return program


def run(*command):
    """Seconds of processor that it takes."""
    start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([*map(str, command)], check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start


def directional_map(program, surface, tiles, folder):
    """(UVs, seconds)"""
    with (folder / "mesh.off").open("w", encoding="ascii") as file:
        file.write(f"OFF\n{len(surface.vertices)} {len(surface.triangles)} 0\n")
        np.savetxt(file, surface.vertices, fmt="%.17g")
        np.savetxt(file, np.insert(surface.triangles, 0, 3, axis=1), fmt="%d")
    seconds = run(program, folder / "mesh.off", tiles, folder / "uv")
    return np.loadtxt(folder / "uv"), seconds


def ceps_map(program, surface, folder):
    """(surface, UVs, seconds): edges that the method flips are vertices of its mesh."""
    surface.write(folder / "mesh.obj")
    made = folder / "ceps.obj"
    seconds = run(
        program, folder / "mesh.obj", f"--greedyConeMaxU={CEPS_SCALE}", f"--outputLinearTextureFilename={made}"
    )
    lines = [line.split() for line in made.read_text(encoding="ascii").splitlines()]
    vertices, uv = (np.array([line[1:] for line in lines if line[:1] == [kind]], float) for kind in ("v", "vt"))
    corners = [[corner.split("/") for corner in line[1:]] for line in lines if line[:1] == ["f"]]
    fans = [[face[0], *two] for face in corners for two in zip(face[1:-1], face[2:])]
    at, values = np.array(fans, int).transpose(2, 0, 1) - 1
    return holomorph.Surface(vertices, at), uv[values].reshape(-1, 2), seconds


def signed_areas(uv):
    a, b, c = uv.reshape(-1, 3, 2).transpose(1, 2, 0)
    doubled = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
    return doubled * np.sign(doubled.sum()) / 2


def seam_length(surface, uv):
    z, ends = uv.reshape(-1, 3, 2) @ [1, 1j], np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], -1)
    values, ends = np.stack([z, np.roll(z, -1, axis=1)], -1).reshape(-1, 2), ends.reshape(-1, 2)
    order = np.lexsort(np.sort(ends, axis=1).T)
    one, other = order[::2], order[1::2]
    (a, b), (d, c) = values[one].T, values[other].T  # two triangles run along their edge in opposite directions
    with np.errstate(invalid="ignore"):  # an edge without length has no turn, and is no seam
        turn = 1j ** np.rint(np.angle((b - a) / (d - c)) * 2 / np.pi)
    shifts = np.stack([a - turn * c, b - turn * d])
    off = np.maximum(np.abs(shifts.real - np.rint(shifts.real)), np.abs(shifts.imag - np.rint(shifts.imag))).max(axis=0)
    lengths = np.linalg.norm(np.subtract(*surface.vertices[ends[one]].transpose(1, 0, 2)), axis=1)
    return lengths[off > TORN].sum() / np.linalg.norm(np.ptp(surface.vertices, axis=0))


def print_row(name, surface, uv, seconds):
    found = holomorph.distortion.measure(surface, uv)
    cells = [f"{value:.2f}" for value in (found.size_range, found.mean_angle, found.upright_part)]
    cells += [
        np.count_nonzero(signed_areas(uv) < 0),
        *(f"{value:.1f}" for value in (seam_length(surface, uv), seconds)),
    ]
    print("|", name, "|", " | ".join(map(str, cells)), "|", flush=True)


def compare(path, directional, ceps, tiles, folder):
    given = holomorph.Surface.read(path)
    surface = holomorph.Surface(given.vertices, given.triangles)
    uv, seconds = directional_map(directional, surface, tiles, folder)
    print_row(f"{path.stem}: Directional", surface, uv, seconds)
    if ceps:
        print_row("CEPS", *ceps_map(ceps.resolve(), surface, folder))
    density = np.abs(signed_areas(uv)).sum() / surface.area
    for direction, evenness in OURS:
        start = time.process_time()
        made = holomorph.automatic_map(
            surface, main="seamless", turns=4, density=density, direction=direction, evenness=evenness
        )
        name = f"{'any direction' if direction is None else direction}, {evenness}"
        print_row(name, surface, made.uv, time.process_time() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directional", type=Path)
    parser.add_argument("meshes", nargs="*", type=Path, default=[MESHES / name for name in DEFAULT])
    parser.add_argument("--tiles", type=float, default=50, help="Directional's, over the diagonal of the bounding box")
    parser.add_argument("--ceps", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        program = compiled(options.directional, Path(name))
        columns = ("map", "size range", "s1/s2", "upright", "flipped", "seams", "seconds")
        print("|", " | ".join(columns), "|")
        print("|---" * len(columns) + "|")
        for path in options.meshes:
            compare(path, program, options.ceps, options.tiles, Path(name))


main()
