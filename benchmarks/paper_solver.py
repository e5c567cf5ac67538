# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/paper_solver.py [MESH ...] [--faces N ...] [--json FILE]

The paper's multiresolution algorithm (section 9) against conjugate gradients begun at zero, on the same linear system
with the same code: the mesh files named, and surfaces of about N faces by marching tetrahedra (genus 2, irregular) and
bumpy tori. Of a mesh with boundary the system is that of its double. One thread, processor time. Work is counted in
iterations on the surface, those of a level by its part of the surface's faces.

Prints how many times faster the paper's solver (with L scaled to a diagonal of ones, as the library has it; and without
scaling) is than plain conjugate gradients and than scaled ones, to relative residuals of 1e-4 to 1e-10: in work; in
seconds of solving, all levels included; in seconds with the progressive mesh and its bases.
"""

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

from meshes import bumpy_torus, double_torus, write_ply
from programs import ROOT, program

RESIDUALS = ("1e-4", "1e-6", "1e-8", "1e-10")
SURFACES = {"irregular": double_torus, "bumpy torus": bumpy_torus}


def measured(paper_solver, mesh):
    """What the program prints, one thread."""
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    line = subprocess.run([paper_solver, mesh], capture_output=True, text=True, check=True, env=environment).stdout
    return json.loads(line)


def speeds(result, paper, other):
    """Rows of ratios to each residual: work, seconds of solving, seconds of all."""
    levels = result[paper]["levels"]
    work = sum(faces * iterations for faces, iterations in levels) / result["faces"]
    solving = result[paper]["levels_seconds"]
    before = result["progressive_mesh"] + result["homology_of_base"]
    rows = []
    for a, b in zip(result[paper]["surface"], result[other], strict=True):
        if not a or not b:
            rows.append((float("nan"),) * 3)
            continue
        everything = (b[1] + result["homology_of_surface"]) / (a[1] + solving + before)
        rows.append((b[0] / (a[0] + work), b[1] / (a[1] + solving), everything))
    return rows


def print_table(name, result):
    print(f"{name}: {result['faces']} faces, {result['right_hand_sides']} right-hand sides")
    print(f"  iterations to {', '.join(RESIDUALS)}")
    for method in ("plain", "scaled"):
        print(f"    {method + ' from zero':24} {[run[0] if run else None for run in result[method]]}")
    for method in ("paper_plain", "paper"):
        levels = ", ".join(f"{faces}: {iterations}" for faces, iterations in result[method]["levels"])
        runs = [run[0] if run else None for run in result[method]["surface"]]
        print(f"    {method:24} {runs}; levels {levels}")
    print("  times faster: work / seconds of solving / seconds with the progressive mesh")
    for paper, other in (("paper", "plain"), ("paper", "scaled"), ("paper_plain", "plain")):
        cells = (f"{work:5.2f} /{solve:5.2f} /{all_:5.2f}" for work, solve, all_ in speeds(result, paper, other))
        print(f"    {paper + ' : ' + other:24} {'   '.join(cells)}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--faces", nargs="*", type=int, default=[15_000, 60_000, 250_000, 1_000_000])
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "paper_solver.json")
    options = parser.parse_args()
    paper_solver = program("paper_solver")
    results = []
    with tempfile.TemporaryDirectory() as folder:
        todo = [(mesh.name, mesh) for mesh in options.meshes]
        for faces in options.faces:
            for name, make in SURFACES.items():
                todo.append((name, (Path(folder) / f"{name}_{faces}.ply", make, faces)))
        for name, mesh in todo:
            if isinstance(mesh, tuple):
                path, make, faces = mesh
                mesh = write_ply(path, *make(faces))
            result = {"surface": name, **measured(paper_solver, mesh)}
            results.append(result)
            print_table(name, result)
            options.json.parent.mkdir(parents=True, exist_ok=True)
            options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
