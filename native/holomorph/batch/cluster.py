"""The same tasks on a Dask cluster, whose workers see the sources and the output folder under the same paths.

Each thread of a Dask worker has a process of its own that does the work, as it is done locally: a crash, a hang or a
memory bomb costs its asset and no Dask worker. Dask does again what was on a worker that is lost.
"""

import contextlib
import queue
import threading
import time
from dataclasses import replace
from pathlib import Path

import distributed

from . import CRASHED, EngineError, UsageError
from .journal import publish, stored
from .workers import MEMORY_SHARE, Worker, machine_memory, records

CONNECT_SECONDS = 10.0
CLOSE_SECONDS = 1.0
RECONNECT_SECONDS = 600.0  # a scheduler that is gone may take so long to come back
LOOK_SECONDS = 2.0  # how often it is looked whether the scheduler is there
# TimeoutError is an OSError.
GONE = OSError, distributed.client.FutureCancelledError, distributed.comm.CommClosedError

_own = threading.local()
_started = []  # the workers of all threads of this process


class Cluster:
    """A scheduler. @throws UsageError where it does not answer"""

    def __init__(self, address):
        self._address, self._futures = address, []
        try:
            self._client = self._connected()
        except (*GONE, ValueError, TypeError) as error:  # the last at a tls:// address without a certificate
            raise UsageError(f"--dask: no scheduler answers at {address}: {error}") from error

    def run(self, tasks):
        """Yields the record of each task as it is done. Raises StorageError, and EngineError where the scheduler stays
        away."""
        waiting = {task.key: task for task in tasks}
        try:
            while waiting:
                try:
                    yield from self._done(waiting)
                except GONE:
                    self._reconnect()
        finally:
            if waiting:
                with contextlib.suppress(*GONE):
                    self._client.cancel(self._futures)
                    self._client.run(stop, tasks[0].work)

    def _connected(self):
        place = {"scheduler_file" if Path(self._address).is_file() else "address": self._address}
        return distributed.Client(**place, timeout=CONNECT_SECONDS)

    def _reconnect(self):
        with contextlib.suppress(*GONE):
            self._client.close(timeout=CLOSE_SECONDS)
        end = time.monotonic() + RECONNECT_SECONDS
        while True:
            try:
                self._client = self._connected()
                return
            except (*GONE, ValueError) as error:
                if time.monotonic() > end:
                    raise EngineError(f"the scheduler at {self._address} did not come back") from error
                time.sleep(LOOK_SECONDS)

    def _done(self, waiting):
        """Yields records and takes their tasks out of `waiting`. @throws GONE"""
        ready, self._futures = queue.Queue(), []  # forgotten futures are not computed
        for rank, task in enumerate(waiting.values()):
            future = self._client.submit(work, task, key=f"holomorph-{task.key}", priority=-rank)
            future.add_done_callback(lambda future, task=task: ready.put((task, future)))
            self._futures.append(future)
        while waiting:
            try:
                task, future = ready.get(timeout=LOOK_SECONDS)
            except queue.Empty:
                if self._client.status != "running" or any(future.status == "lost" for future in self._futures):
                    raise distributed.comm.CommClosedError from None
                continue
            try:
                record = future.result()
            except distributed.KilledWorker as error:
                message = f"several Dask workers stopped while working on it: {error}"
                record = publish(task, {"status": CRASHED, "message": message, "seconds": 0.0}, {})
            yield record
            del waiting[task.key]


def work(task):
    """On a Dask worker: the record of a task, which may have been done by one that was lost before it could tell."""
    if not hasattr(_own, "worker"):
        _own.worker = Worker()
        _started.append(_own.worker)
    limits = replace(task.limits, memory=task.limits.memory or _share())
    return stored(task) or next(records([replace(task, limits=limits)], [_own.worker]))


def stop(folder):
    """Runs on a Dask worker: ends its work for the run that writes into this folder first."""
    for worker in _started:
        if worker.task and worker.task.work == folder:
            worker.stop()


def _share():
    """Bytes for each thread of this Dask worker."""
    worker = distributed.get_worker()
    memory = worker.memory_manager.memory_limit or machine_memory()
    return int(MEMORY_SHARE * memory / worker.state.nthreads)
