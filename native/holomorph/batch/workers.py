"""Processes that work on assets, and what becomes of an asset when its process fails."""

import contextlib
import errno
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import Pipe
from pathlib import Path

from .errors import CRASHED, MEMORY, TIME
from .journal import publish

MEMORY_SHARE = 0.8  # part of a machine's memory, for all its workers together
START = Path(__file__).with_name("start.py").absolute()
ATTEMPTS = 2  # at an asset whose process ends: it may have been ended from outside


@dataclass(frozen=True)
class Limits:
    """Limits for each asset: bytes of memory, seconds, and the threads that its process uses."""

    memory: int
    seconds: float
    threads: int = 1


class Stopped(Exception):
    """Raised when the worker was told to stop before the task was done."""


class Worker:
    """A process that is started for the first task, and again after each failure."""

    def __init__(self, limits):
        self._limits, self._process, self._stopped = limits, None, False
        self._lock = threading.Lock()

    def do(self, task):
        """The record of the task, whose results are written then. @throws StorageError, Stopped"""
        start, status = time.perf_counter(), CRASHED
        left = ATTEMPTS
        while status == CRASHED and left > 0:
            left -= 1
            status, answer = self._answer(task)
        if status is None:
            return answer
        seconds = time.perf_counter() - start
        return publish(task, {"status": status, "message": answer, "seconds": seconds}, {})

    def stop(self):
        """Ends the process; a task in it is not done. From any thread."""
        with self._lock:
            self._stopped = True
            self._end()

    def _answer(self, task):
        """(None, record), or the kind of failure and a sentence."""
        connection = self._connected()
        try:
            connection.send(task)
            if not connection.poll(self._limits.seconds):
                self._renew()
                return TIME, f"not done after {self._limits.seconds:g} s, the time limit"
            answer = connection.recv()
        except (EOFError, OSError):
            return CRASHED, f"its process {self._renew()}"
        if isinstance(answer, Exception):
            raise answer
        if answer["status"] == MEMORY:
            self._renew()
            return MEMORY, f"more than {self._limits.memory / 2**20:.0f} MB, the memory limit, are needed"
        return None, answer

    def _connected(self):
        with self._lock:
            if self._stopped:
                raise Stopped
            if self._process is None:
                self._start()
            return self._connection

    def _start(self):
        with contextlib.ExitStack() as ours, contextlib.ExitStack() as theirs:
            self._connection, other = Pipe()
            ours.callback(self._connection.close)
            theirs.callback(other.close)
            lifeline, self._lifeline = os.pipe()
            ours.callback(os.close, self._lifeline)
            theirs.callback(os.close, lifeline)
            arguments = [str(other.fileno()), str(lifeline), str(self._limits.memory)]
            threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": str(self._limits.threads)}
            self._process = subprocess.Popen(
                [sys.executable, "-P", str(START), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                pass_fds=(other.fileno(), lifeline),
                start_new_session=True,  # Ctrl-C is for the process that has the terminal
                env=os.environ | threads | _python_path(),
            )
            ours.pop_all()  # are closed with the process

    def _renew(self):
        """Ends the process, and tells how it ended; the next task starts another."""
        with self._lock:
            if self._stopped:
                raise Stopped
            return self._end()

    def _end(self):
        if self._process is None:
            return ""
        ended = self._process.poll()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        code = self._process.wait() if ended is None else ended
        self._connection.close()
        os.close(self._lifeline)
        self._process = None
        return f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with {code}"


def _python_path():
    """What the environment says of where modules are, without the current folder, for which an empty entry stands."""
    entries = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    return {"PYTHONPATH": os.pathsep.join(os.path.abspath(entry) for entry in entries if entry)}


def machine_memory():
    """Bytes: of the machine, or what a process may have of it."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return whole if limit == resource.RLIM_INFINITY else min(whole, limit)


def _begun(threads, work, order):
    """The futures. @throws OSError where no thread can be started, as where there are no more processes"""
    try:
        return [threads.submit(work, task) for task in order]
    except RuntimeError as error:
        raise OSError(errno.EAGAIN, str(error)) from error


def run(tasks, limits, count):
    """Yields the record of each task as it is done, the largest first, by `count` processes. @throws StorageError"""
    workers = [Worker(limits) for _ in range(count)]
    free = list(workers)

    def work(task):
        worker = free.pop()  # there are as many threads as workers
        try:
            return worker.do(task)
        finally:
            free.append(worker)

    order = sorted(tasks, key=lambda task: (-task.size, task.name))
    with ThreadPoolExecutor(count) as threads:
        try:
            waiting = _begun(threads, work, order)
            for done in as_completed(waiting):
                yield done.result()
        finally:
            threads.shutdown(wait=False, cancel_futures=True)
            for worker in workers:
                worker.stop()
