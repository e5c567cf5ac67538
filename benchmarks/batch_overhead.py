# SPDX-License-Identifier: GPL-3.0-or-later
"""What a batch takes beside the work on its assets: batch_overhead.py [--assets 2000] [--faces 5000] [--workers 2]

Prints milliseconds for each asset: the time of all workers that is not spent in the work itself, their start included,
and the processor time of the whole run beside that of the work; with --dask also the time that two Dask workers take,
over that of one. An idle machine is needed.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

RECIPE = "[maps]\nmain = 'balanced'\n"
DASK_WORKERS = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=int(sys.argv[1]), threads_per_worker=1, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def torus_file(path, faces, fatness):
    around = round(np.sqrt(2 * faces))
    across = round(faces / around)
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    radius = 3 + fatness * np.cos(b)
    points = np.stack([radius * np.cos(a), fatness * np.sin(b), radius * np.sin(a)], axis=-1).reshape(-1, 3)
    corners = [(u + i) % around * across + (v + j) % across + 1 for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    text = "v %r %r %r\n" * len(points) % tuple(points.ravel().tolist())
    path.write_text(text + "f %d %d %d %d\n" * len(quads) % tuple(quads.ravel().tolist()))


def timed(folder, out, *arguments):
    """(seconds, processor seconds) of a run of the command."""
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "holomorph", "batch", folder / "library", "--out", out]
    subprocess.run([*command, "--recipe", folder / "recipe.toml", *arguments], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - begin, used


def with_dask(folder, workers):
    """Seconds of a run on a local cluster that is there already."""
    command = [sys.executable, "-c", DASK_WORKERS, str(workers)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as cluster:
        address = cluster.stdout.readline().strip()
        seconds, _ = timed(folder, folder / f"dask{workers}", "--dask", address)
        cluster.stdin.close()
    return seconds


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--assets", type=int, default=2000)
    parser.add_argument("--faces", type=int, default=5000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--dask", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "library").mkdir()
        (folder / "recipe.toml").write_text(RECIPE)
        for number, fatness in enumerate(np.linspace(0.5, 2.0, options.assets)):
            torus_file(folder / "library" / f"torus_{number:05d}.obj", options.faces, fatness)
        seconds, used = timed(folder, folder / "out", "--workers", str(options.workers))
        records = [json.loads(path.read_bytes()) for path in (folder / "out/assets").rglob("record.json")]
        assert len(records) == options.assets
        work, work_used = (sum(each[key] for each in records) for key in ("seconds", "processor_seconds"))
        print(f"{options.assets} assets of {options.faces} faces, {options.workers} workers: {seconds:.1f} s")
        waited, spent = seconds * options.workers - work, used - work_used
        print(f"beside the work, for each asset: {1000 * waited / options.assets:.1f} ms of its worker's time,")
        print(f"{1000 * spent / options.assets:.1f} ms of processor time")
        if options.dask:
            one, two = with_dask(folder, 1), with_dask(folder, 2)
            print(f"Dask: one worker {one:.1f} s, two {two:.1f} s: {two / one:.2f}")


if __name__ == "__main__":
    main()
