# SPDX-License-Identifier: GPL-3.0-or-later
"""What is chosen on a mesh (faces, vertices, seams, method). No bpy here."""

from dataclasses import dataclass

import numpy as np

from ..native import module

structures = module("maps.chosen_structures")

# What the selection is.
AUTOMATIC, POLES, RECTANGLE, NONE = structures.AUTOMATIC, structures.POLES, structures.RECTANGLE, structures.NONE
FACES = "FACES"
# Which faces are mapped: all; in edit mode the selected ones if there are any; these, or a refusal.
WHOLE, SELECTED, ASKED = "WHOLE", "SELECTED", "ASKED"
ISLANDS, NO_EDGES = structures.ISLANDS, structures.NO_EDGES


@dataclass(frozen=True)
class Choices(structures.Choices):
    """What is asked of every object of a run, and then, with its own vertices and seams, of each."""

    cut_at_seams: bool = False
    faces: str = WHOLE  # which ones are mapped
    modifiers: bool = False  # whether they count, in object mode


def numbers(text):
    """The complex numbers in a text like "1 1 -2" or "1+0.5j, -1-0.5j"; raises ValueError naming what is none."""
    result = []
    for word in text.replace(",", " ").split():
        try:
            number = complex(word)
        except ValueError:
            number = complex("nan")
        if not np.isfinite(number):
            raise ValueError(f"residues: {word!r} is not a number")
        result.append(number)
    return tuple(result)
