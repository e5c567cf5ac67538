"""The results of a batch on disk: a folder for each asset, whole or not there. The folders are the journal, too: a
record in each tells what it was made of, so that a second run, or one that goes on, does only what is missing.

DIR/assets/NAME/record.json, report.json, picture.png, ...     DIR/.work/ : what is being written, emptied at each start
"""

import contextlib
import ctypes
import fcntl
import json
import os
import shutil
import uuid
from pathlib import Path

from .errors import StorageError, UsageError

RECORD = "record.json"
HERE, EXCHANGE = -100, 2  # AT_FDCWD, RENAME_EXCHANGE of Linux


class Journal:
    """What is done in an output folder."""

    def __init__(self, folder, share=""):
        """share : a name for one of several runs, each of which does a share of the work; none for a run alone"""
        self.folder, self._share = Path(folder), share
        self.work = self.folder / ".work" / (share or "all")

    @contextlib.contextmanager
    def locked(self):
        """Makes the folder, and keeps other runs out, but those of other shares. @throws UsageError, StorageError"""
        with contextlib.ExitStack() as locks:
            with storing():
                self.folder.mkdir(parents=True, exist_ok=True)
                names = [".lock", f".lock-{self._share}"] if self._share else [".lock"]
                files = [locks.enter_context(open(self.folder / name, "a")) for name in names]
            try:
                fcntl.flock(files[0], (fcntl.LOCK_SH if self._share else fcntl.LOCK_EX) | fcntl.LOCK_NB)
                fcntl.flock(files[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise UsageError(f"{self.folder}: another batch is writing here") from error
            self._empty_work()
            try:
                yield self
            finally:
                self._empty_work()

    def _empty_work(self):
        """Empties the folder of work; if this run is alone, also those of shares that were killed."""
        shutil.rmtree(self.work if self._share else self.work.parent, ignore_errors=True)
        with storing():
            self.work.mkdir(parents=True)

    def write(self, name, content):
        """Writes a file of the whole batch, whole or not at all. @throws StorageError"""
        with storing():
            path = self.work / f"{name}-{uuid.uuid4().hex}"
            path.write_bytes(content)
            os.replace(path, self.folder / name)


@contextlib.contextmanager
def storing():
    """Turns OSError into StorageError."""
    try:
        yield
    except OSError as error:
        raise StorageError(f"{os.fsdecode(error.filename or 'the results')}: {error.strerror}") from error


def stored(task):
    """What is noted of a task's results; None where there are none, they are not whole, or of something else."""
    try:
        record = json.loads((task.folder / RECORD).read_bytes())
        is_whole = all((task.folder / name).stat().st_size == size for name, size in record["files"].items())
    except (OSError, ValueError, KeyError):
        return None
    return record if is_whole and record["key"] == task.key else None


def publish(task, record, files):
    """Writes a task's results beside their place, then moves them there in one step, and returns what is noted. Older
    ones stay until then, but where a file system cannot exchange folders: there they are moved away first.
    @throws StorageError"""
    new = task.work / uuid.uuid4().hex
    noted = {"name": task.name, "key": task.key, **record, "files": {name: len(files[name]) for name in sorted(files)}}
    with storing():
        try:
            new.mkdir()
            for name, content in files.items():
                (new / name).write_bytes(content)
            (new / RECORD).write_text(json.dumps(noted, indent=1) + "\n", encoding="utf-8")
            task.folder.parent.mkdir(parents=True, exist_ok=True)
            if not _exchanged(new, task.folder):
                if task.folder.exists():
                    os.replace(task.folder, task.work / uuid.uuid4().hex)
                os.replace(new, task.folder)
        finally:
            shutil.rmtree(new, ignore_errors=True)
    return noted


def _exchanged(new, old):
    """Whether two folders got each other's names, in one step. Not where one is missing, or the file system cannot."""
    rename = getattr(ctypes.CDLL(None), "renameat2", None)
    names = os.fsencode(new), os.fsencode(old)
    return rename is not None and rename(HERE, names[0], HERE, names[1], EXCHANGE) == 0
