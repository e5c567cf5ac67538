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

from ..files import whole_file
from ..quality.verdicts import LEVELS
from . import ALL, StorageError, UsageError

RECORD = "record.json"
MOST_BYTES = 2**24  # of a record
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
                self._check_own()
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

    def _check_own(self):
        """What is emptied, and what is waited for, lies here and is of the kind that was made. @throws UsageError"""
        for path in {self.work, self.work.parent}:
            if path.is_symlink() or (path.exists() and not path.is_dir()):
                raise UsageError(f"{path}: this is not a folder of a batch, which would be emptied: remove it")
        for path in self.folder.glob(".lock*"):
            if path.is_symlink() or not path.is_file():
                raise UsageError(f"{path}: this is not the file of a batch, which would be locked: remove it")

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
    record = noted(task)
    return record if record and record["key"] == task.key else None


def noted(task):
    """The same of whatever the results were made of."""
    try:
        record = json.loads(whole_file.read(task.folder / RECORD, MOST_BYTES))
        if not _is_record(record):
            return None
        is_whole = all((task.folder / name).stat().st_size == size for name, size in record["files"].items())
    except (OSError, ValueError, RecursionError):
        return None
    return record if is_whole else None


def _is_record(found):
    """Whether it has what `publish` notes, each of its kind: other programs write into folders, too."""
    kinds = {"name": str, "key": str, "status": str, "message": str, "seconds": (int, float), "files": dict}
    if not isinstance(found, dict) or not all(isinstance(found.get(name), kind) for name, kind in kinds.items()):
        return False
    level, skipped = found.get("verdict"), found.get("skipped", 0)
    is_known = found["status"] in ALL and (level is None or level in LEVELS) and isinstance(skipped, int)
    return is_known and all(Path(name).name == name for name in found["files"])


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
