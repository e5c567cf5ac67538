"""Put the files of a package compiled for another platform into a wheel: make-wheel.py STAGE TAG FOLDER.

STAGE has the package, TAG is that of the wheel's name, as in cp311-cp311-win_amd64.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

from scikit_build_core.build import prepare_metadata_for_build_wheel

DATE = "946684800"  # the first second of 2000, for every file: the same sources give the same wheel


def main(stage, tag, folder):
    # The project's own description, which says of the tag that it is this computer's.
    wheel = Path(stage, prepare_metadata_for_build_wheel(stage), "WHEEL")
    wheel.write_text(re.sub("(?m)^Tag: .*$", f"Tag: {tag}", wheel.read_text()))
    pack = [sys.executable, "-m", "wheel", "pack", stage, "--dest-dir", folder]
    subprocess.run(pack, check=True, env={**os.environ, "SOURCE_DATE_EPOCH": DATE}, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(*sys.argv[1:])
