# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/progressive_mesh.py [MESH ...] [--faces N ...] [--json FILE]

Faces per second of the progressive mesh, one thread, against OpenMesh's Decimater (quadrics, normal check, progressive
mesh records) in the same run: of the mesh files named, and of bumpy tori with about N faces. Prints ratios and writes
the seconds as JSON.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build" / "cmake" / "benchmarks"


def built():
    """The program, compiled as the library is."""
    pybind11 = subprocess.run(
        [sys.executable, "-m", "pybind11", "--cmakedir"], capture_output=True, text=True, check=True
    )
    options = [f"-DPython_EXECUTABLE={sys.executable}", f"-Dpybind11_DIR={pybind11.stdout.strip()}"]
    configure = ["cmake", "-S", ROOT, "--preset", "release", "-B", BUILD, "-DHOLOMORPH_BENCHMARKS=ON", *options]
    subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", BUILD, "--target", "progressive_mesh", "--", "--quiet"], check=True)
    return BUILD / "benchmarks" / "progressive_mesh"


def bumpy_torus(faces, path):
    """An irregular torus: grid points moved by up to 0.3 of a step, the radius wavy."""
    m = round((faces / 4) ** 0.5)
    n = 2 * m
    i, j = np.divmod(np.arange(n * m), m)
    noise = np.random.default_rng(0).uniform(-0.3, 0.3, (2, n * m))
    theta, phi = 2 * np.pi * (i + noise[0]) / n, 2 * np.pi * (j + noise[1]) / m
    r = 1 + 0.1 * np.sin(5 * theta) * np.cos(3 * phi)
    rho = 2 + r * np.cos(phi)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=1)
    right, up = (i + 1) % n, (j + 1) % m
    a, b, c, d = i * m + j, right * m + j, right * m + up, i * m + up
    triangles = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        np.savetxt(file, points, fmt="%.9g")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), fmt="%d")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--faces", nargs="*", type=int, default=[60_000, 250_000, 1_000_000])
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "progressive_mesh.json")
    arguments = parser.parse_args()
    program = built()
    results = []
    with tempfile.TemporaryDirectory() as folder:
        tori = [bumpy_torus(faces, Path(folder) / f"torus_{faces}.off") for faces in arguments.faces]
        print(
            f"{'mesh':28} {'faces':>8} {'quadric':>9} {'independent':>12} {'restore':>8} {'OpenMesh':>9} {'ratio':>6}"
        )
        print(f"{'':28} {'':>8} {'million faces per second':^42}")
        for mesh in [*arguments.meshes, *tori]:
            line = subprocess.run([program, mesh], capture_output=True, text=True, check=True).stdout
            result = json.loads(line)
            results.append(result)
            speed = {
                key: result["faces"] / 1e6 / result[key] for key in ("quadric", "independent", "restore", "openmesh")
            }
            ratio = result["openmesh"] / result["quadric"]
            columns = (
                f"{speed[key]:{width}.{digits}f}"
                for key, width, digits in zip(speed, (9, 12, 8, 9), (2, 2, 2, 3), strict=True)
            )
            print(f"{result['mesh']:28} {result['faces']:8} {' '.join(columns)} {ratio:6.1f}", flush=True)
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    arguments.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
