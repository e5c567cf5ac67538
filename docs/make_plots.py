# SPDX-License-Identifier: GPL-3.0-or-later
"""The plots of docs/python: make_plots.py FOLDER leaves checker, density, zeros and loops of the pretzel there."""

import sys
from pathlib import Path

import holomorph
from holomorph import plot

PRETZEL = Path(__file__).resolve().parents[1] / "examples" / "pretzel.obj"
SQUARES = 25


def main():
    folder = Path(sys.argv[1])
    structure = holomorph.conformal_structure(holomorph.Surface.read(PRETZEL))
    uv = structure.uv(structure.balanced_coefficients())
    pictures = {
        "checker": plot.checker(structure.surface, uv, squares=SQUARES),
        "density": plot.density(structure.surface, uv),
        "zeros": plot.zeros(structure),
        "loops": plot.loops(structure),
    }
    for name, picture in pictures.items():
        picture.savefig(folder / f"{name}.png", dpi=130)


main()
