"""minimise.py TARGET FILE: makes an input that breaks something smaller, as long as it breaks in the same way."""

import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import worker

HERE = Path(__file__).resolve().parent
PATIENCE = 120  # seconds for one input

REPLAY = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import worker
import oracle
target = worker.target_named(sys.argv[2])
worker.begin_watch()
print(oracle.answer(target.execute, target.load(Path(sys.argv[3]))))
"""


def replayed(name, path):
    """The ended process that tried one file."""
    command = [sys.executable, "-c", REPLAY, str(HERE), name, str(path)]
    return subprocess.run(command, capture_output=True, text=True, errors="replace")


def signature(ended):
    """What a process died of, without the numbers; "" if it did not."""
    if not ended.returncode:
        return ""
    if ended.returncode == -signal.SIGPROF:
        return "Timeout"
    for pattern in (r"ERROR: AddressSanitizer: ([\w-]+)", r"(runtime error: .*)", r"(Timeout) \("):
        if match := re.search(pattern, ended.stderr):
            return re.sub(r"[\d.]+", "#", match[1])
    last = (ended.stderr.strip().splitlines() or [""])[-1]
    return re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?", "#", last) or f"exit code {ended.returncode}"


def minimised(name, target, case, stem):
    """The file of the smallest case found that breaks in the same way."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    kept = target.save(case, stem)
    wanted, end = signature(replayed(name, kept)), time.monotonic() + PATIENCE
    smaller = True
    with tempfile.TemporaryDirectory() as folder:
        while smaller and wanted:
            smaller = False
            for candidate in target.smaller(case):
                if time.monotonic() > end:
                    return kept
                if signature(replayed(name, target.save(candidate, Path(folder, "candidate")))) == wanted:
                    case, smaller = candidate, True
                    kept = target.save(case, stem)
                    break
    return kept


if __name__ == "__main__":
    path = Path(sys.argv[2])
    target = worker.target_named(sys.argv[1])
    print(minimised(sys.argv[1], target, target.load(path), path.with_suffix("")))
