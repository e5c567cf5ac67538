"""Files that are read, and that are written whole or not at all."""

import contextlib
import errno
import os
import stat
from pathlib import Path

EMPTY = bytes(2**12)
ROOM = 2**17  # bytes: as large as what disks give at a time


def write(path, *contents):
    """Writes bytes, one after the other, beside the path and moves them there in one step: what is there stays as it
    was where the disk is full or the process ends. Links are followed. A pipe, or what else is not a file, is written
    into directly.

    Raises OSError that names the path."""
    with _naming(path):
        place = _place(path)
        if place.exists() and not place.is_file():
            with open(place, "wb") as file:
                file.writelines(contents)
            return
        new = place.with_name(_hidden_name())
        try:
            with open(new, "xb") as file:
                file.writelines(contents)
                file.flush()
                os.fsync(file.fileno())
            _move(new, place)
        finally:
            new.unlink(missing_ok=True)


def read(path, most=None):
    """The bytes of a file. A pipe, or what else is not a file, is not waited for.

    most : a larger file is refused

    Raises OSError that names the path."""
    with _naming(path), open(os.fspath(path), "rb", opener=_without_waiting) as file:
        state = os.fstat(file.fileno())
        _require_file(state)
        if most is not None and state.st_size > most:
            raise OSError(errno.EFBIG, f"it has {state.st_size:,} bytes; at most {most:,} are read")
        return file.read()


def require_file(path):
    """Raises OSError that names the path, where it is that of no file: before any work, to tell what was misspelled."""
    with _naming(path):
        _require_file(os.stat(path))


def _require_file(state):
    if not stat.S_ISREG(state.st_mode):
        raise OSError(errno.EINVAL, "this is not a file but a folder, a pipe or a device")


def _without_waiting(path, flags):
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))


def check_places(sources, output, others, overwrite):
    """Checks, before any work, that files can be where they will be written, and none is written over another one.

    sources : the files that are read; output : None or where the result goes, which may be a source where `overwrite`
        is true; others : paths of other files that are written, None for none

    Raises ValueError."""
    read = {_place(path) for path in sources}
    if output is not None and _place(output) in read and not overwrite:
        raise ValueError(f"{output} is the input file: use --overwrite to replace it")
    taken = read - {output and _place(output)}
    for path in filter(None, (output, *others)):
        place = _place(path)
        if place in taken:
            raise ValueError(f"{path} is used twice in this run and would be overwritten")
        if not place.parent.is_dir():
            raise ValueError(f"{path}: the folder {place.parent} does not exist")
        if place.is_dir():
            raise ValueError(f"{path} is a folder: the name of a file is needed")
        written = place if place.exists() and not place.is_file() else place.parent  # as `write` does
        if not os.access(written, os.W_OK):
            raise ValueError(f"{path}: nothing may be written to {written}")
        taken.add(place)


@contextlib.contextmanager
def file_beside(path):
    """The path of a new file of the same kind in the same folder, which in the end is moved to where the path is; after
    an error, what is there stays as it was.

    Raises OSError that names the path."""
    place = _place(path)
    new = place.with_name(_hidden_name() + Path(path).suffix)
    try:
        yield new
        with _naming(path):
            require_room(new)
            _move(new, place)
    finally:
        new.unlink(missing_ok=True)


@contextlib.contextmanager
def folder_beside(path):
    """A new folder, in which the path's name and files beside it are written: in the end all are moved to where the
    path is. Without any, and after an error, what is there stays as it was.

    Raises OSError that names the path."""
    place = _place(path)
    new = place.with_name(_hidden_name())
    with _naming(path):
        new.mkdir()
    try:
        yield new
        with _naming(path):
            written = sorted(each for each in new.rglob("*") if each.is_file())
            for made in written:
                require_room(made)
            for made in written:
                target = place.parent / made.relative_to(new)
                target.parent.mkdir(exist_ok=True)
                _move(made, target)
    finally:
        import shutil  # which imports what packs archives

        shutil.rmtree(new, ignore_errors=True)


def require_room(path):
    """For a file that another program wrote: not all tell that the disk was full. Then it is full now, too.

    Raises OSError where nothing can be added to the file."""
    with open(path, "r+b", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        try:
            for _ in range(ROOM // len(EMPTY)):
                if file.write(EMPTY) < len(EMPTY):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(file.fileno())
        finally:
            file.truncate(size)


def _place(path):
    """Where a link leads; to itself if it is circular."""
    return Path(os.path.realpath(path))


def _hidden_name():
    return f".{os.urandom(16).hex()}"


def _move(new, place):
    """Keeps the mode of a file that is replaced."""
    with contextlib.suppress(FileNotFoundError):
        os.chmod(new, stat.S_IMODE(os.stat(place).st_mode))
    os.replace(new, place)


@contextlib.contextmanager
def _naming(path):
    try:
        yield
    except OSError as error:
        raise type(error)(error.errno, error.strerror, os.fspath(path)) from error
