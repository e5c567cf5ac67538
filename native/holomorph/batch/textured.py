"""The turns of the texture that goes into files: those of maps that follow it, and where it lies on maps that turn."""

from dataclasses import replace

import numpy as np

from ..files import textures
from ..tiles.height_image import height_image
from ..tiling.image_turns import image_turns
from ..tiling.request import AUTO, AUTOMATIC, LINED_TURNS


def symmetry(recipe):
    """The `ImageTurns` of the recipe's texture by its brightness, None where maps do not turn. Files repeat images in
    squares: those that look the same after a sixth turn have half turns there. Raises ValueError, OSError as
    `height_image`."""
    texture = recipe.output.texture
    if texture is None or recipe.tiling.turns == 1:
        return None
    found = image_turns(_squares() if texture == textures.CHECKER else height_image(texture)[::-1])
    return replace(found, turns=2) if found.turns == 6 else found


def _squares():
    """The pixels of a checker of two by two squares."""
    return np.kron(np.eye(2), np.ones((2, 2)))


def resolved(recipe, found):
    """The `Recipe` with numbers of turns, where it leaves them to its texture. found : `symmetry` of that"""
    tiling = recipe.tiling
    if tiling.turns != AUTO:
        return recipe
    turns = found.turns if found else 1
    lines = tiling.lines if turns in LINED_TURNS else AUTOMATIC
    return replace(recipe, tiling=replace(tiling, turns=turns, lines=lines))


def moved(uv, surface, parts, recipe, found):
    """(#C, 2) UVs of files. Where a map turns, the centre of the texture's turns lies at the corners of tiles."""
    if found is None or all(part.map is None or part.map.turns == 1 for part in parts):
        return uv
    images = textures.checker_squares(surface, uv) / 2 if recipe.output.texture == textures.CHECKER else 1
    return uv + np.array(found.centre) / images
