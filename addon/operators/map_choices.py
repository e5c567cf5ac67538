# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked for by the properties of the operators of maps, or by the headless command under the same names."""

import math

from ..maps.options import MapOptions, TileOptions, dials
from ..materials import material
from ..materials.own import IMAGE, MATERIAL
from ..results.write import WriteOptions
from ..solving import choices

FACES = {"AUTOMATIC": choices.SELECTED, "FACES": choices.ASKED}  # by the use of the selection


def request(properties):
    """The `choices.Choices`. @throws ValueError residues that are not numbers"""
    are_islands, use = properties.main == "ISLANDS", properties.use_selection
    return choices.Choices(
        use=choices.NONE if use == choices.FACES else use,
        faces=FACES.get(use, choices.WHOLE),
        residues=choices.numbers(properties.residues),
        cut_at_seams=properties.cut_at_seams or are_islands,
        boundary=choices.ISLANDS if are_islands else properties.boundary,
        solver=properties.solver,
        modifiers=properties.modifiers,
        hard_edges=math.degrees(properties.hard_edges) if are_islands else 0.0,
        most_stretch=properties.most_stretch if are_islands else 0.0,
    )


def options(properties, _target, own=None):
    """The `options.MapOptions`, the same for every object, with the `own.Own` that is the texture."""
    lattice = {} if own is None else {"lattice": own.lattice}
    return MapOptions(
        properties.forms,
        properties.density,
        properties.rotation,
        tuple(properties.amounts),
        tuple(properties.turns),
        properties.margin,
        properties.main,
        tiling=TileOptions(density=density(properties.size, 1), **lattice, **dials(properties)),
    )


def write_options(properties, own=None):
    texture = shown_texture(properties.texture, own)
    show = properties.shown, properties.checker, texture, properties.checker_scale
    return WriteOptions(*show, properties.seams, properties.shape, size=properties.size, own=own)


def density(size, repeats):
    """The UV area over the area of the surface, for images of the texture of a width, of which `repeats` lie side by
    side in a UV unit; 0 where no size is asked for."""
    return 1 / (size * repeats) ** 2 if size else 0.0


def shown_texture(texture, own):
    """The checker where the user's own texture is not yet chosen."""
    return material.CHECKER if texture in (IMAGE, MATERIAL) and own is None else texture
