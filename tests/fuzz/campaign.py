"""Long runs: workers try numbered inputs, findings are told, minimised and kept; see scripts/fuzz.

campaign.py [--minutes N] [--target NAME]... [--first N] [--keep FOLDER]
"""

import argparse
import collections
import contextlib
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import minimise
import worker

ROUND = 30  # seconds that a target has before the next one's turn
TOLD = 20  # lines of what a dying worker said


@dataclass
class Tally:
    """What is known of one target: the next number, the inputs tried, their answers, the numbers of those that broke
    something, by the signature of what broke."""

    next: int
    tried: int = 0
    answers: collections.Counter = field(default_factory=collections.Counter)
    findings: dict = field(default_factory=dict)


def turn(name, tally, seconds):
    """Lets one worker try inputs for some seconds, or until one of them breaks something."""
    with tempfile.NamedTemporaryFile() as state:
        command = worker.command(name, "try", tally.next, seconds, state.name)
        ended = subprocess.run(command, capture_output=True, text=True, errors="replace")
        seen = json.loads(state.read() or b'{"number": -1, "answers": {}}')
    if seen["number"] < tally.next:
        raise SystemExit(f"the worker of {name} did not begin:\n{ended.stderr}")
    tally.tried += seen["number"] - tally.next
    tally.answers.update(seen["answers"])
    tally.next = seen["number"]
    if ended.returncode:
        found(name, tally, ended)
        tally.tried += 1
        tally.next += 1


def found(name, tally, ended):
    """Counts a finding, and tells of the first of its kind."""
    kind = minimise.signature(ended)
    if kind not in tally.findings:
        lines = [line for line in ended.stderr.splitlines() if line.strip() and "/python3" not in line]
        print(f"{name} {tally.next}: {kind}", *lines[-TOLD:], sep="\n    ", flush=True)
    tally.findings.setdefault(kind, []).append(tally.next)


def run(names, minutes, first, keep):
    """The tallies of all targets, which take turns."""
    tallies = {name: Tally(first) for name in names}
    end = time.monotonic() + 60 * minutes
    with contextlib.suppress(KeyboardInterrupt):  # counts what there is
        while (left := end - time.monotonic()) > 0:
            for name in names:
                turn(name, tallies[name], min(ROUND, max(left / len(names), 1)))
    for name in names:
        print(f"{name}: {tallies[name].tried} inputs, {dict(tallies[name].answers)}")
        for kind, numbers in tallies[name].findings.items():
            print(f"{name}: {len(numbers)} times {kind}: {', '.join(map(str, numbers[:9]))}")
            if keep:
                print(f"    kept as {minimise.kept(name, numbers[0], keep)}", flush=True)
    return tallies


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument(
        "--target", action="append", help=f"one of {', '.join(worker.TARGETS)}, operator; default: the three"
    )
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    parser.add_argument("--keep", type=Path, help="folder for what breaks something, made small")
    options = parser.parse_args()
    tallies = run(options.target or worker.TARGETS, options.minutes, options.first, options.keep)
    findings = sum(len(numbers) for tally in tallies.values() for numbers in tally.findings.values())
    print(f"{sum(tally.tried for tally in tallies.values())} inputs, {findings} findings")
    sys.exit(findings > 0)


if __name__ == "__main__":
    main()
