# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/arrays_to_forms.py [--faces N ...] [--threads N ...] [--runs N]

From arrays to Omega, and to the forms on the surface's own triangles, beside a short program with CHOLMOD and OpenBLAS
(benchmarks/cholmod_forms.cpp) that checks nothing and bounds nothing: on irregular surfaces of genus 2, in turns, the
shortest of the runs. Processor time of user and system, which other work changes least, and by the clock.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from meshes import double_torus, write_ply
from programs import ROOT, program

PACKAGE = ROOT / "build" / "lib" / f"cp{sys.version_info.major}{sys.version_info.minor}"
sys.path[:0] = [str(PACKAGE)]


def spent():
    """By the clock, and of the processor."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return time.perf_counter(), usage.ru_utime + usage.ru_stime


def own(vertices, triangles, threads):
    """{"omega", "forms"}: (clock, processor) seconds of the library."""
    import holomorph

    start = spent()
    structure = holomorph.conformal_structure(holomorph.Surface(vertices, triangles), threads=threads)
    structure.period_matrix  # noqa: B018
    middle = spent()
    structure.harmonic_forms  # noqa: B018
    end = spent()
    return {name: [b - a for a, b in zip(start, stop)] for name, stop in (("omega", middle), ("forms", end))}


def other(command, mesh, threads):
    """(clock, processor) seconds of the program: its second run, which has its memory."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": str(threads)}
    said = subprocess.run([command, mesh, "2"], env=environment, capture_output=True, text=True, check=True).stdout
    last = json.loads(said.splitlines()[-1])
    return [last["clock"], last["user"] + last["system"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[1])
    parser.add_argument("--faces", nargs="*", type=int, default=[100_000, 300_000, 1_000_000])
    parser.add_argument("--threads", nargs="*", type=int, default=[1, 2])
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    command = program("cholmod_forms")
    columns = ("program", "omega", "forms", "omega/", "forms/")
    print(f"{'faces':>9} {'threads':>8} {'':6}" + "".join(f"{name:>10}" for name in columns))
    for faces in options.faces:
        vertices, triangles = double_torus(faces)
        with tempfile.TemporaryDirectory() as folder:
            mesh = write_ply(Path(folder) / "mesh.ply", vertices, triangles)
            for threads in options.threads:
                runs = [(other(command, mesh, threads), own(vertices, triangles, threads)) for _ in range(options.runs)]
                for i, kind in enumerate(("clock", "cpu")):
                    theirs = min(run[0][i] for run in runs)
                    ours = [min(run[1][name][i] for run in runs) for name in ("omega", "forms")]
                    seconds = "".join(f"{value:10.3f}" for value in (theirs, *ours))
                    ratios = "".join(f"{value / theirs:10.2f}" for value in ours)
                    print(f"{len(triangles):>9} {threads:>8} {kind:6}{seconds}{ratios}", flush=True)


if __name__ == "__main__":
    main()
