# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/solvers.py [MESH ...] [--faces N ...] [--runs N] [--json FILE] [--plot FILE]

Every solver of L x = b on the same surfaces, four right-hand sides, as many threads as the machine has cores: the
library's multigrid, counted from the mesh's arrays on, against the others, counted from their assembled matrix. Each
runs in a process of its own, so its peak memory is its own; the median of the runs counts. "again" is a later run in
the same process, with its memory in place. How multigrid's time grows from each size of a surface to the next is
measured on both sizes in turn, for the machine may be faster or slower a few minutes later; how much of that is the
size of the caches, by as many systems of the smaller size, of which each does an iteration in turn. The surfaces:
marching tetrahedra of genus 2 (irregular), the same with cuts down to 0.001 of an edge (bad), a torus grid, smooth and
stretched 20:1, and the mesh files named. CHOLMOD comes with OpenBLAS. Prints ratios against the better of CHOLMOD's
two orderings.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from meshes import BAD, double_torus, torus, write_ply
from programs import ROOT, program

SURFACES = {
    "irregular": double_torus,
    "bad": lambda faces: double_torus(faces, BAD),
    "torus": torus,
    "stretched": lambda faces: torus(faces, 20.0),
}
# The most faces with which a solver is tried: beyond, it takes minutes.
MOST_FACES = {
    "multigrid": 10**9,
    "direct": 10**9,
    "cholmod-amd": 10**9,
    "cholmod-metis": 10**9,
    "ldlt": 400_000,
    "amg": 1_500_000,
    "jacobi-cg": 1_500_000,
    "cg": 100_000,
}
AGAIN = ("multigrid", "cholmod-amd")
RUNS_OF_A_PROCESS = 3
CHOLMOD = ("cholmod-amd", "cholmod-metis")
RIGHT_HAND_SIDES = 4


def output_of(program_and_arguments, environment=None):
    return subprocess.run(program_and_arguments, capture_output=True, text=True, check=True, env=environment).stdout


def measured(solvers, mesh, method, tolerance):
    """The run of a new process; "again" is the last of those in it."""
    if method == "amg":
        return measured_amg(solvers, mesh, tolerance)
    command = [solvers, mesh, method, str(RIGHT_HAND_SIDES), str(tolerance)]
    if method in AGAIN:
        command.append(str(RUNS_OF_A_PROCESS))
    # Waiting for work, OpenBLAS's threads would take a core from a solver that has no use for them.
    environment = os.environ if method in CHOLMOD else {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    first, *others = map(json.loads, output_of(command, environment).splitlines())
    if others:
        first["again"] = seconds(method, others[-1])
    return first


def measured_amg(solvers, mesh, tolerance):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "matrix"
        output_of([solvers, mesh, f"matrix={file}", str(RIGHT_HAND_SIDES), str(tolerance)])
        python = [sys.executable, Path(__file__).with_name("pyamg_solver.py")]
        return json.loads(output_of([*python, file, str(tolerance)]))


def seconds(method, result):
    own = result["assembly"] if method in ("multigrid", "direct") else 0.0
    return own + result["set_up"] + result["solve"]


def compare(solvers, name, mesh, faces, options):
    """Measures every solver in turn, so that a load on the machine meets all of them; returns rows for the table."""
    methods = [m for m in options.methods if faces <= MOST_FACES[m]]
    runs = {m: [] for m in methods}
    for _ in range(options.runs):
        for method in methods:
            slow = method in ("cg", "jacobi-cg", "ldlt", "amg")
            if not (slow and runs[method]):
                runs[method].append(measured(solvers, mesh, method, options.tolerance))
    rows = []
    for method, results in runs.items():
        results.sort(key=lambda r: seconds(method, r))
        median = results[len(results) // 2]
        rows.append({"surface": name, "method": method, "seconds": seconds(method, median), **median, "faces": faces})
        if "again" in median:
            rows[-1]["again"] = statistics.median(r["again"] for r in results)
    return rows


def growth(solvers, small, large, options):
    """How many times as long the larger mesh takes: in new processes, and again in each of them. Medians of rounds."""
    rounds = []
    for _ in range(options.runs):
        pair = [measured(solvers, mesh, "multigrid", options.tolerance) for mesh in (small, large)]
        rounds.append([[seconds("multigrid", run), run["again"]] for run in pair])
    of_small, of_large = np.median(rounds, axis=0)
    return dict(zip(("new", "again"), of_large / of_small, strict=True))


def growth_of_iteration(in_turn, small, large, systems, options):
    """How many times as long an iteration on the larger mesh takes as one on the smaller, and as many `systems` of the
    smaller, an iteration of each in turn."""
    of_small, of_large = (
        json.loads(output_of([in_turn, mesh, str(count), str(options.runs)]))
        for mesh, count in ((small, systems), (large, 1))
    )
    return {
        "systems": systems,
        "iteration": of_large["alone"] / of_small["alone"],
        "in_turn": systems * of_small["in_turn"] / of_small["alone"],
    }


def print_table(rows):
    best, best_again = (
        min((r[key] for r in rows if r["method"] in CHOLMOD and key in r), default=np.nan)
        for key in ("seconds", "again")
    )
    for r in rows:
        again = f"{r['again']:8.3f} s {r['again'] / best_again:7.2f}" if "again" in r else " " * 18
        print(
            f"{r['surface']:14} {r['faces']:>8} {r['method']:14} {r['seconds']:9.3f} s  {r['seconds'] / best:8.2f}  "
            f"{again}  "
            f"{r['assembly']:6.3f} {r['set_up']:7.3f} {r['solve']:8.3f}  {r['iterations']:6} {r['residual']:9.1e}  "
            f"{r['peak_bytes'] / 1e9:6.2f} GB",
            flush=True,
        )


def print_growth(small, row):
    print(
        f"{row['surface']}: {row['faces'] / small:.2f} times the faces of {small} take "
        f"{row['growth']['again']:.2f} times as long, {row['growth']['new']:.2f} in new processes; "
        f"an iteration {row['growth']['iteration']:.2f} times, of {row['growth']['systems']} systems of {small} faces "
        f"in turn {row['growth']['in_turn']:.2f} times",
        flush=True,
    )


def plot(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    names = list(dict.fromkeys(r["surface"] for r in rows))
    figure, axes = pyplot.subplots(1, len(names), figsize=(4 * len(names), 4), squeeze=False, sharey=True)
    for axis, name in zip(axes[0], names, strict=True):
        for method in MOST_FACES:
            points = sorted((r["faces"], r["seconds"]) for r in rows if (r["surface"], r["method"]) == (name, method))
            if points:
                axis.loglog(*zip(*points, strict=True), "o-", label=method, linewidth=3 if method == "multigrid" else 1)
        axis.set(title=name, xlabel="faces")
        axis.grid(True, which="both", alpha=0.3)
    axes[0, 0].set_ylabel("seconds")
    axes[0, -1].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--faces", nargs="*", type=int, default=[50_000, 250_000, 1_000_000, 4_000_000])
    parser.add_argument("--surfaces", nargs="*", choices=SURFACES, default=list(SURFACES))
    parser.add_argument("--methods", nargs="*", choices=MOST_FACES, default=list(MOST_FACES))
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--tolerance", type=float, default=1e-10, help="relative residual of the iterative solvers")
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "solvers.json")
    parser.add_argument("--plot", type=Path, default=ROOT / "build" / "solvers.png")
    options = parser.parse_args()
    solvers, in_turn = program("solvers"), program("systems_in_turn")
    print(f"{os.cpu_count()} cores, {RIGHT_HAND_SIDES} right-hand sides, relative residual {options.tolerance:g}")
    print(
        f"{'':38} {'seconds':>11}  {'/CHOLMOD':>8}  {'again':>10} {'/CHOLMOD':>7}  "
        f"{'asm':>6} {'set-up':>7} {'solve':>8}  {'iter.':>6}"
    )
    rows, smaller = [], {}
    with tempfile.TemporaryDirectory() as folder:
        for faces in options.faces:
            for name in options.surfaces:
                vertices, triangles = SURFACES[name](faces)
                mesh = write_ply(Path(folder) / f"{name}_{faces}.ply", vertices, triangles)
                here = compare(solvers, name, mesh, len(triangles), options)
                rows += here
                print_table(here)
                own = [r for r in here if r["method"] == "multigrid"]
                if name in smaller:
                    small, small_mesh = smaller[name]
                    for row in own:
                        row["growth"] = growth(solvers, small_mesh, mesh, options)
                        systems = round(len(triangles) / small)
                        row["growth"] |= growth_of_iteration(in_turn, small_mesh, mesh, systems, options)
                        print_growth(small, row)
                    small_mesh.unlink()
                smaller[name] = len(triangles), mesh
        for mesh in options.meshes:
            faces = measured(solvers, mesh, "multigrid", options.tolerance)["faces"]
            here = compare(solvers, mesh.stem[:14], mesh, faces, options)
            rows += here
            print_table(here)
    options.json.parent.mkdir(parents=True, exist_ok=True)
    options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    if rows:
        plot(rows, options.plot)


if __name__ == "__main__":
    main()
