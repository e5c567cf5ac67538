"""Programs run with a time limit."""

import subprocess

SECONDS = 300


def run(*command, seconds=SECONDS):
    """Run a program with a time limit: what it did."""
    return subprocess.run([*map(str, command)], timeout=seconds, text=True, capture_output=True, check=False)


def output(*command, seconds=SECONDS):
    done = run(*command, seconds=seconds)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}\n{done.stderr}"
    return done.stdout
