"""Processes that work on assets, and what becomes of an asset when its process fails.

python -P .../holomorph/batch/start.py CONNECTION MEMORY is one of them, with the file descriptor of the connection to
the process that started it, and the bytes that each asset may take.
"""

import contextlib
import os
import queue
import resource
import signal
import subprocess
import sys
import threading
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from pathlib import Path

import numpy as np

from .. import Surface, conformal_structure
from ..core import unexpected
from . import CRASHED, MEMORY, TIME, StorageError
from .journal import publish, storing

MEMORY_SHARE = 0.8  # part of a machine's memory, for all its workers together
START = Path(__file__).with_name("start.py").absolute()
ATTEMPTS = 2  # at an asset whose process ends: it may have been ended from outside
LONGEST_WAIT = 3600.0  # seconds, at a time: systems do not wait for months
FAULT = "fault.txt"  # beside the record of an asset: what is to be sent


class Stopped(Exception):
    """Raised where the process was told to stop before the task was done."""


class Worker:
    """A process that is started for the first task, and again after each failure, or for other limits."""

    def __init__(self):
        self.task, self._process, self._limits = None, None, None

    def begin(self, task):
        """Sends a task to the process. @throws OSError where none can be started"""
        if task.limits != self._limits:
            self.end()
        self.task, self._limits, self._start = task, task.limits, time.monotonic()
        self._attempts, self._stopped = 0, False
        self._try()

    def _try(self):
        if self._process is None:
            self._connection, self._process = _started(self._limits)
        self._attempts += 1
        self.deadline = time.monotonic() + self._limits.seconds
        with contextlib.suppress(OSError):  # where it ended: then nothing is received
            self._connection.send(self.task)

    def fileno(self):
        """What is waited for."""
        return self._connection.fileno()

    def record(self):
        """That of the task, whose results are written then, once the process told or is late; None where it is tried
        again. @throws StorageError, Stopped, and OSError as `begin`"""
        answer = self._answer()
        if "key" not in answer:
            if answer["status"] == CRASHED and self._attempts < ATTEMPTS:
                return self._try()
            answer = publish(self.task, answer | {"seconds": time.monotonic() - self._start}, {})
        self.task = None
        return answer

    def _answer(self):
        """The record, or the status and the message of a failure, of which nothing is written yet."""
        if not self._connection.poll():
            self.end()
            return {"status": TIME, "message": f"not done after {self._limits.seconds:g} s, the time limit"}
        try:
            answer = self._connection.recv()
        except (EOFError, OSError):
            ended = self.end()
            if self._stopped:
                raise Stopped from None
            return {"status": CRASHED, "message": f"its process {ended}"}
        if isinstance(answer, Exception):
            raise answer
        if answer is None:
            self.end()
            told = f"more than {self._limits.memory / 2**20:.0f} MB, the memory limit, are needed"
            return {"status": MEMORY, "message": told}
        return answer

    def stop(self):
        """Kills the process; a task in it is not done. From any thread."""
        self._stopped = True
        if self._process is not None:
            _kill(self._process)

    def end(self):
        """Ends the process, and tells how it ended."""
        if self._process is None:
            return ""
        ended = self._process.poll()
        _kill(self._process)
        code = self._process.wait() if ended is None else ended
        self._connection.close()
        self._process = None
        return f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with {code}"


def _kill(process):
    """With the programs that it started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _started(limits):
    """(connection, process) of a new process. @throws OSError"""
    connection, other = Pipe()
    paths = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))  # an empty one is the current folder
    environment = {
        "PYTHONPATH": os.pathsep.join(paths),
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": str(limits.threads),
    }
    with other:
        process = subprocess.Popen(
            [sys.executable, "-P", str(START), str(other.fileno()), str(limits.memory)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            pass_fds=[other.fileno()],
            start_new_session=True,  # Ctrl-C is for the process that has the terminal
            env=os.environ | environment,
        )
    return connection, process


def machine_memory():
    """Bytes: of the machine, or what a process may have of it."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return whole if limit == resource.RLIM_INFINITY else min(whole, limit)


def records(tasks, workers):
    """Yields the record of each task as it is done. @throws StorageError, Stopped, and OSError where no process can be
    started"""
    waiting, free, busy = list(tasks)[::-1], list(workers), []
    while waiting or busy:
        while waiting and free:
            busy.append(free.pop())
            busy[-1].begin(waiting.pop())
        left = min(worker.deadline for worker in busy) - time.monotonic()
        told = wait(busy, min(max(left, 0.0), LONGEST_WAIT))
        for worker in told or [worker for worker in busy if worker.deadline <= time.monotonic()]:
            record = worker.record()
            if record:
                busy.remove(worker)
                free.append(worker)
                yield record


def run(tasks, count):
    """The same, by `count` processes of this machine, which end with it."""
    workers = [Worker() for _ in range(count)]
    try:
        yield from records(tasks, workers)
    finally:
        for worker in workers:
            worker.end()


def main():
    """In the process: sends for each task its record, a `StorageError`, or None where memory is lacking. Then it ends:
    another one begins with memory that is whole."""
    connection, tasks, has_memory, answer = Connection(int(sys.argv[1])), queue.SimpleQueue(), True, CRASHED
    threading.Thread(target=_receive, args=[connection, tasks], daemon=True).start()
    try:
        _warm_up()
        _limit(int(sys.argv[2]))
    except MemoryError:
        has_memory = False
    while answer:
        task = tasks.get()
        answer = _done(task) if has_memory else None
        connection.send(answer)


def _receive(connection, tasks):
    """Ends this process and the programs it started when the one that started it is gone."""
    try:
        while True:
            tasks.put(connection.recv())
    finally:
        os.killpg(0, signal.SIGKILL)


def _done(task):
    start = time.perf_counter()
    try:
        with storing():
            return publish(task, *task.run())
    except MemoryError:
        return None
    except StorageError as error:
        return error
    except Exception as error:  # noqa: BLE001  the outer door of an asset: other assets are done
        message = f"{unexpected.sentence(error)}; please send {FAULT}, which holds no mesh"
        record = {"status": CRASHED, "message": message, "seconds": time.perf_counter() - start}
        with storing():
            return publish(task, record, {FAULT: unexpected.report(error).encode(errors="backslashreplace")})


def _warm_up():
    """OpenBLAS takes 128 MB for itself at its first use, of which it touches little, and waits without end where it
    does not get them: before the limit it does. There are two of them, NumPy's and CHOLMOD's. @throws MemoryError"""
    grid = np.arange(9).reshape(3, 3)
    corners = [np.roll(grid, shift, (0, 1)) for shift in ((0, 0), (1, 0), (1, 1), (0, 1))]
    points = np.sin(np.arange(27.0) ** 2).reshape(-1, 3)  # a torus that goes through itself
    conformal_structure(Surface(points, np.stack(corners, axis=-1).reshape(-1, 4)), solver="direct")
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
