# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/pyamg_solver.py MATRIX TOLERANCE: conjugate gradients preconditioned by PyAMG's smoothed
aggregation, one right-hand side after the other, for a file that `solvers MESH matrix=FILE` wrote. One vertex is
pinned: with the singular matrix it does not always converge. One line of JSON."""

import json
import sys
import time
from pathlib import Path

import numpy as np
import pyamg
from scipy.sparse import csr_matrix


def read(path):
    with open(path, "rb") as file:
        n, entries, count = np.fromfile(file, np.int64, 3)
        starts, columns = np.fromfile(file, np.int32, n + 1), np.fromfile(file, np.int32, entries)
        values = np.fromfile(file, np.float64, entries)
        return csr_matrix((values, columns, starts), shape=(n, n)), np.fromfile(file).reshape(count, n).T


def peak_bytes():
    """The peak of this process alone: getrusage counts what its parent had before it as well."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return 1024 * int(status.split("VmHWM:")[1].split()[0])


def main():
    L, B = read(sys.argv[1])
    L, B = L[1:, 1:].tocsr(), B[1:]
    tolerance = float(sys.argv[2])
    start = time.perf_counter()
    hierarchy = pyamg.smoothed_aggregation_solver(L, B=np.ones((L.shape[0], 1)), symmetry="symmetric")
    ready = time.perf_counter()
    residuals, iterations = [], []
    for b in B.T:
        history = []
        x = hierarchy.solve(b, tol=tolerance, accel="cg", maxiter=500, residuals=history)
        iterations.append(len(history) - 1)
        residuals.append(np.linalg.norm(L @ x - b) / np.linalg.norm(b))
    end = time.perf_counter()
    result = {
        "name": f"PyAMG {pyamg.__version__}, smoothed aggregation and conjugate gradients",
        "assembly": 0.0,
        "set_up": ready - start,
        "solve": end - ready,
        "iterations": max(iterations),
        "residual": max(residuals),
        "peak_bytes": peak_bytes(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
