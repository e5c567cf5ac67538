"""The sanitizer of this run sees Python's process: defects made on purpose end it, and our module is instrumented.

The library of defects is made by the builds with sanitizers; scripts/test names it.
"""

import os
import subprocess
import sys
from pathlib import Path

import holomorph._native
import pytest

LIBRARY = os.environ.get("HOLOMORPH_PLANTED_DEFECTS")
# For each sanitizer's run-time library: what it is to find, and what instrumented code calls.
DEFECTS = {
    "asan": ["heap_overflow(10): heap-buffer-overflow", "signed_overflow(2**31 - 1): signed integer overflow"],
    "tsan": ["data_race(): data race"],
}
CALLS = {"asan": b"__asan_report_", "tsan": b"__tsan_read"}
SANITIZER = next((name for name in DEFECTS if f"lib{name}" in os.environ.get("LD_PRELOAD", "")), None)

pytestmark = pytest.mark.skipif(not (LIBRARY and SANITIZER), reason="no sanitizer")


def run(call):
    program = f"import ctypes; ctypes.CDLL({LIBRARY!r}).{call}"
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("defect", DEFECTS.get(SANITIZER, []))
def test_planted_defect_ends_the_process(defect):
    call, message = defect.split(": ")
    ended = run(call)
    assert ended.returncode != 0
    assert message in ended.stderr


def test_without_a_defect_nothing_is_found():
    ended = run("signed_overflow(1)")
    assert (ended.returncode, ended.stderr) == (0, "")


def test_the_module_is_instrumented():
    assert CALLS[SANITIZER] in Path(holomorph._native.__file__).read_bytes()
