"""Errors that nothing foresaw: one sentence for the user, and a report by which their cause can be found."""

import contextlib
import os
import platform
import sys
import tempfile
import traceback

from .. import _native
from . import addresses
from .value import shortened

STATUS = 70  # the exit status of a fault inside a program, EX_SOFTWARE of sysexits.h


def told(error: BaseException) -> str:
    """The sentence; the report that it names is written."""
    path = _written(report(error))
    where = f"please send the report {path}, which holds no mesh{_to()}" if path else "the report could not be written"
    return "; ".join([sentence(error), *getattr(error, "__notes__", ()), where])


def _to():
    return f", to {addresses.ISSUES}" if addresses.ISSUES else ""


def sentence(error: BaseException) -> str:
    """What happened, without the report."""
    words = " ".join(str(error).split())
    return f"this is a fault of Holomorph, not of the data: {type(error).__name__}" + (
        f" ({shortened(words)})" if words else ""
    )


def report(error: BaseException) -> str:
    """What is needed to find the cause: the call, where the error was raised, and on what."""
    frames = "".join(traceback.format_exception(error))
    return (
        f"Holomorph {_native.__version__}, Python {platform.python_version()}, {platform.platform()}\n"
        f"{' '.join(map(repr, sys.orig_argv))}\n\n{frames}"
    )


def _written(text):
    """The path of a new file in the folder for temporary files; empty where there is no room."""
    with contextlib.suppress(OSError):
        number, path = tempfile.mkstemp(prefix="holomorph-fault-", suffix=".txt")
        with os.fdopen(number, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(text)
        return path
    return ""
