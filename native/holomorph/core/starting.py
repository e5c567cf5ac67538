"""Imported before all else: what must be so before NumPy is loaded where the package is started as a command.

Elsewhere this does nothing: signals and the environment are those of the program that imports the package.
"""

import os
import signal
import sys

LEAST_MEMORY = 320 * 2**20  # bytes of address space that Python, NumPy and the native core take before any work
ROOM = 2**32  # bytes: with less, a library's workspace for each thread would take a large part


def is_command():
    """Whether this process is `python -m holomorph` or the script of that name."""
    if sys.argv[:1] != ["-m"]:  # which it is while the package of a module to run is imported
        return bool(sys.argv) and os.path.basename(sys.argv[0]) in ("holomorph", "holomorph.exe")
    return is_module()


def is_module():
    """Whether this process is `python -m holomorph`."""
    words = sys.orig_argv
    return "-m" in words and words[words.index("-m") + 1 :][:1] == [__package__.rpartition(".")[0]]


def prepare():
    """Ends the process in one sentence where there is too little memory, and at Ctrl-C from here on. Nothing more is
    imported from the current folder, where `python -m` looks first: assets lie there."""
    if sys.argv[:1] == ["-m"] and not sys.flags.safe_path and sys.path[0] != _own_folder():
        del sys.path[0]
    signal.signal(signal.SIGINT, lambda number, frame: _end(130, "interrupted before anything was done"))
    limit = _address_space()
    if limit < LEAST_MEMORY:
        _end(1, f"the memory limit (ulimit -v) is {limit >> 20} MB; at least {LEAST_MEMORY >> 20} MB are needed")
    if limit < ROOM:
        for name in ("OPENBLAS_NUM_THREADS", "OMP_THREAD_LIMIT"):
            os.environ.setdefault(name, "1")


def _own_folder():
    """The folder that the package is in."""
    return os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def _address_space():
    """The limit, in bytes."""
    try:
        import resource
    except ImportError:  # Windows
        return ROOM
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return ROOM if limit == resource.RLIM_INFINITY else limit


def _end(status, sentence):
    try:
        os.write(2, f"holomorph: {sentence}\n".encode())
    finally:
        os._exit(status)


if is_command():
    prepare()
