# SPDX-License-Identifier: GPL-3.0-or-later
"""python benchmarks/pyamg_solver.py MATRIX TOLERANCE: conjugate gradients preconditioned by PyAMG's smoothed
aggregation, one right-hand side after the other, for a file that `solvers MESH matrix=FILE` wrote. One line of JSON."""

import json
import resource
import sys
import time

import numpy as np
import pyamg
from scipy.sparse import csr_matrix


def read(path):
    with open(path, "rb") as file:
        n, entries, count = np.fromfile(file, np.int64, 3)
        starts, columns = np.fromfile(file, np.int32, n + 1), np.fromfile(file, np.int32, entries)
        values = np.fromfile(file, np.float64, entries)
        return csr_matrix((values, columns, starts), shape=(n, n)), np.fromfile(file).reshape(count, n).T


def main():
    L, B = read(sys.argv[1])
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
        "peak_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
