"""The wheels, the source and the zips, of a release or made here."""

import os
import subprocess
from pathlib import Path

from repository import ROOT

SECONDS = 600


def run(*command, seconds=SECONDS, **environment):
    """Run a program away from the checkout, with a time limit; its output, or a failure that shows it."""
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "HOLOMORPH_BLENDER")}
    done = subprocess.run(
        # The program "timeout" ends what the command started, too.
        ["timeout", "--kill-after=10", str(seconds), *map(str, command)],
        env={**clean, **{name: str(value) for name, value in environment.items()}},
        cwd="/",
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\nexit code {done.returncode}\n{done.stdout}"
    return done.stdout


def packages(folder):
    """Where they are: HOLOMORPH_DIST, of a release, or this folder, in which they are made."""
    if os.environ.get("HOLOMORPH_DIST"):
        return Path(os.environ["HOLOMORPH_DIST"])
    run(ROOT / "scripts" / "package-extension", folder)
    return folder


def extension(dist):
    """The extension for this computer."""
    return next(dist.glob("holomorph-*-linux_x64.zip"))
