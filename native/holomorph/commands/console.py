"""How the commands talk and end: no name garbles a terminal, and what each may meet ends it in one sentence."""

import argparse
import contextlib
import errno
import os
import signal
import sys

from .._native import __version__
from ..core import addresses, starting, unexpected

INTERRUPTED = 130  # exit status after Ctrl-C, or SIGTERM, as shells have it
JOINERS = "\u200c\u200d"  # which scripts and pictures need between letters


def shown(text):
    r"""The text on one line, without what a terminal acts on or a reader cannot see: they, and bytes that are no
    UTF-8, become \n, \x1b, \u202e, \xff; a backslash becomes two, so that no two texts become one."""
    return "".join(map(_shown, text))


def _shown(character):
    if character == "\\":
        return "\\\\"
    if character.isprintable() or character in JOINERS:
        return character
    if "\udc80" <= character <= "\udcff":  # how Python holds a byte that is no UTF-8
        return f"\\x{ord(character) - 0xDC00:02x}"
    return character.encode("unicode_escape").decode()


def tell(text):
    """Writes to standard output at once. @throws OSError that names it, where it is closed or full"""
    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF))
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        _silence(1)
        raise OSError(error.errno, error.strerror, "standard output") from error


def say(sentence, end="\n"):
    """Writes a line to the error stream; where that is closed or full, the exit status alone tells."""
    try:
        if sys.stderr is not None:
            sys.stderr.write(sentence + end)
            sys.stderr.flush()
    except OSError:
        _silence(2)


def warn(path, sentences):
    """Says on the error stream what is wrong with a file that was read all the same."""
    for sentence in sentences:
        say(f"holomorph: {shown(str(path))}: {sentence}")


def failed(status, problem):
    """The exit status, after one sentence about an error, or a text, on the error stream."""
    if isinstance(problem, OSError) and problem.filename is not None:
        problem = f"{os.fsdecode(problem.filename)}: {problem.strerror}"
    say(f"holomorph: {shown(str(problem))}")
    return status


class Parser(argparse.ArgumentParser):
    """A parser of the arguments of a command, by default that of single files. It names the program as it was started,
    and ends as the commands do if an output is closed or full. Its help ends with the address of the documentation."""

    def __init__(self, command="", **about):
        program = "python -m holomorph" if starting.is_module() else "holomorph"
        super().__init__(prog=f"{program} {command}".strip(), **about)
        self.add_argument("--version", action="version", version=__version__)

    def format_help(self):
        return super().format_help() + (f"\n{addresses.DOCUMENTATION}\n" if addresses.DOCUMENTATION else "")

    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(2, f"{self.prog}: error: {shown(message)}\n")

    def _print_message(self, message, file=None):
        if file is None or file is sys.stderr:
            say(message, end="")
        else:
            tell(message)


def ended(run, refused=1):
    """The exit status of a process that runs a function: `refused` where the system does not give it what it needs."""
    _open_standard_files()
    try:
        _hear_signals()
        status = _finished(run)
        _ignore_signals()
        return status
    except KeyboardInterrupt:
        told = "interrupted; files already written are complete, and the same command does the rest"
        return failed(INTERRUPTED, told)
    except (OSError, MemoryError, ImportError) as error:  # the last of a library that finds no memory
        _ignore_signals()
        return failed(refused, str(error) and error or "there is not enough memory")
    except Exception as error:  # noqa: BLE001  the outer door: nobody is left to raise it to
        _ignore_signals()
        return failed(unexpected.STATUS, unexpected.told(error))


def _finished(run):
    """Returns the status once everything is written."""
    try:
        status = run()
    except SystemExit as end:  # of argparse
        status = end.code or 0
    if sys.stdout is not None:
        tell("")
    say("", end="")
    return status


def _hear_signals():
    """The first Ctrl-C, or the end that a scheduler sends, interrupts; what is done then is not interrupted again."""

    def interrupt(_number, _frame):
        _ignore_signals()
        raise KeyboardInterrupt

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)


def _ignore_signals():
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)


def _open_standard_files():
    """Where their numbers are closed, the next files would have them, and get what is written to an output. Letters
    that the encoding of an output lacks are escaped."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        stream.reconfigure(errors="backslashreplace")
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _silence(number):
    """Drops what is left in a buffer: Python would try to write it again at its end, and fail there."""
    with contextlib.suppress(OSError):
        empty = os.open(os.devnull, os.O_WRONLY)
        os.dup2(empty, number)
        os.close(empty)
