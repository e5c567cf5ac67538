"""minimise.py TARGET FILE: makes an input that breaks something smaller, as long as it breaks in the same way."""

import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import worker

PATIENCE = 120  # seconds for one input


def replayed(name, path):
    """The ended process that tried one file."""
    command = worker.command(name, "replay", path)
    return subprocess.run(command, capture_output=True, text=True, errors="replace")


def kept(name, number, folder):
    """The file of a numbered input that breaks something, made small; one for Blender as it is."""
    folder.mkdir(parents=True, exist_ok=True)
    stem = folder / f"{name}-{number}"
    subprocess.run(worker.command(name, "save", number, stem), check=True, capture_output=True)
    (path,) = folder.glob(f"{stem.name}.*")
    if name == "operator":
        return path
    target = worker.target_named(name)
    return minimised(name, target, target.load(path), stem)


def signature(ended):
    """What a process died of, without the numbers; "" if it did not."""
    if not ended.returncode:
        return ""
    if ended.returncode == -signal.SIGPROF:
        return "Timeout"
    for pattern in (r"ERROR: AddressSanitizer: ([\w-]+)", r"(runtime error: .*)", r"(Timeout) \("):
        if match := re.search(pattern, ended.stderr):
            return re.sub(r"[\d.]+", "#", match[1])
    errors = re.findall(r"(?m)^[\w.]*(?:Error|Exception|Interrupt|Exit)\b.*", ended.stderr)
    last = errors[-1] if errors else ""
    return re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?", "#", last) or f"exit code {ended.returncode}"


def minimised(name, target, case, stem):
    """The file of the smallest case found that breaks in the same way."""
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
