"""Plants faults in the workers of a batch: the name of a mesh file says what happens while it is read. Python imports
this at its start where the folder is on its path."""

import os
import signal
import time
from pathlib import Path

import numpy as np
from holomorph.batch import task

READ = task._read
ENDLESS = 3600  # seconds


def read(path, up):
    kind = path.stem.split("_")[0]
    if kind == "abort":
        os.abort()
    if kind == "hang":
        time.sleep(ENDLESS)
    if kind == "bomb":
        kept = []
        while True:
            kept.append(np.ones(2**22))  # 32 MB
    if kind == "fault":
        return 1 / 0
    if kind == "lost" and _is_first(path):
        os.kill(os.getpid(), signal.SIGKILL)
    if kind == "slow":
        time.sleep(0.3)
    return READ(path, up)


def _is_first(path):
    mark = Path(os.environ["HOLOMORPH_TEST_MARKS"], path.name)
    seen = mark.exists()
    mark.touch()
    return not seen


task._read = read
