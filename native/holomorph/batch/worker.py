"""The process that does the work on assets, one after the other, and may fail at any of them.

python -P .../holomorph/batch/start.py CONNECTION LIFELINE MEMORY: file descriptors of the connection to the process
that started it, and of a pipe that ends when that one does; bytes that each asset may take.
"""

import os
import resource
import signal
import sys
import threading
import time
from multiprocessing.connection import Connection

import numpy as np

from .. import Surface, conformal_structure
from ..core import unexpected
from .errors import CRASHED, MEMORY, StorageError
from .journal import publish, storing

FAULT = "fault.txt"  # beside the record of an asset: what is to be sent


def main():
    connection, lifeline, memory = Connection(int(sys.argv[1])), int(sys.argv[2]), int(sys.argv[3])
    threading.Thread(target=_end_with_parent, args=[lifeline], daemon=True).start()
    done = _done
    try:
        _warm_up()
        _limit(memory)
    except MemoryError:
        done = _without_memory
    while True:
        try:
            task = connection.recv()
        except EOFError:
            return
        answer = done(task)
        connection.send(answer)
        if isinstance(answer, dict) and answer["status"] == MEMORY:
            return  # another process begins with memory that is whole


def _done(task):
    """The record of a task whose results are written, or that lacks memory, or a StorageError."""
    start = time.perf_counter()
    try:
        with storing():
            return publish(task, *task.run())
    except MemoryError:
        return _without_memory(task)
    except StorageError as error:
        return error
    except Exception as error:  # noqa: BLE001  the outer door of an asset: other assets are done
        message = f"{unexpected.sentence(error)}; please send {FAULT}, which holds no mesh"
        record = {"status": CRASHED, "message": message, "seconds": time.perf_counter() - start}
        with storing():
            return publish(task, record, {FAULT: unexpected.report(error).encode(errors="backslashreplace")})


def _without_memory(_task):
    return {"status": MEMORY}


def _warm_up():
    """OpenBLAS takes 128 MB for itself at its first use, of which it touches little, and waits without end where it
    does not get them: before the limit it does. There are two of them, NumPy's and CHOLMOD's. @throws MemoryError"""
    grid = np.arange(9).reshape(3, 3)
    shifted = [np.roll(grid, shift, (0, 1)) for shift in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.stack(shifted, axis=-1).reshape(-1, 4)
    angles = 2 * np.pi / 3 * np.stack(np.divmod(np.arange(9), 3), axis=1)
    radius = 2 + np.cos(angles[:, 1])
    points = np.stack([radius * np.cos(angles[:, 0]), radius * np.sin(angles[:, 0]), np.sin(angles[:, 1])], axis=1)
    conformal_structure(Surface(points, faces), solver="direct")
    np.linalg.inv(np.eye(64) @ np.eye(64))


def _limit(memory):
    """Limits what the process can allocate, beyond what it has now.

    RLIMIT_DATA counts private writable memory. RLIMIT_AS would count libraries and what threads reserve as well, and
    what is resident can only be looked at from time to time, while a bomb goes off in between. Programs that a task
    starts inherit it. Where all memory of the machine runs out, the kernel is to choose a worker.
    """
    with open("/proc/self/status") as status:
        used = next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmData:"))
    hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
    limit = used + memory if hard == resource.RLIM_INFINITY else min(used + memory, hard)
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with open("/proc/self/oom_score_adj", "w") as score:
        score.write("1000")


def _end_with_parent(lifeline):
    """Ends this process and the programs it started when the one that started it is gone."""
    os.read(lifeline, 1)
    os.killpg(0, signal.SIGKILL)
