# SPDX-License-Identifier: GPL-3.0-or-later
"""python docs/make_figures.py [NAME ...]: draws the figures of docs/method into docs/figures, all by default.

They need the package and matplotlib. The command for a fresh checkout is `scripts/figures [NAME ...]`: it builds the
package, makes build/venv/figures (make_venv of scripts/environment) and runs this script in it.

The figures are in figures_of_forms.py and figures_of_maps.py, the surfaces in figure_surfaces.py, how they are drawn in
figure_views.py. The same versions of NumPy and matplotlib draw the same files again.
"""

import sys

from figures_of_forms import bounds, conjugate, cut_graph, digits, harmonic, lattice
from figures_of_maps import annulus, balance, holes, levels, log_map, zeros_and_seams

FIGURES = dict(
    cut_graph=cut_graph, harmonic=harmonic, conjugate=conjugate, bounds=bounds, annulus=annulus, holes=holes,
    log_map=log_map, lattice=lattice, zeros=zeros_and_seams, balance=balance, levels=levels, digits=digits,
)  # fmt: skip

if __name__ == "__main__":
    for name in sys.argv[1:] or FIGURES:
        FIGURES[name]()
