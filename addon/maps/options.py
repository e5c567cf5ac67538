# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the maps of one object. None of them needs a new solve."""

from dataclasses import dataclass, replace

from ..native import holomorph

# What the main map is. TILING: tilings alone, so that parts without one have no map.
AUTOMATIC, SEAMLESS, BALANCED, ISLANDS, TILING = "AUTOMATIC", "SEAMLESS", "BALANCED", "ISLANDS", "TILING"
# The fields of `TileOptions` that every operator and the headless command have under the same name, and that
# `holomorph.automatic_maps` takes as they are.
DIALS = ("evenness",)


def dials(source):
    """The values of `DIALS`, by name."""
    return {name: getattr(source, name) for name in DIALS}


@dataclass(frozen=True)
class TileOptions:
    """The arguments of `holomorph.Structure.tile` for one object."""

    tiles: float = 0.0  # tiles over the whole object; 0 lets the library choose
    density: float = 0.0  # tiles for an area, instead; 0 for their number
    size: tuple = ()  # values of a `holomorph.maps.size.SizePolicy` that counts instead, as it was found with others
    poles: object = "auto"  # or a number for each part, or a tuple of vertices of the object
    lattice: object = "square"  # a name, or its (2, 2) matrix as tuples
    direction: object = "upright"  # or a vector in the frame of the solved polygons, or None
    boundary: str = "automatic"
    turn: float = 0.0  # radians by which the texture is rotated
    quarters: int = 0  # turns of the map by 90 degrees after it is made
    pole_group: str = ""  # the vertex group that `allowed` was read of
    allowed: bytes | None = (
        None  # bytes of the bools that tell where poles may be that are not chosen; None for anywhere
    )
    evenness: float = 0.5  # from 0 for angles to 1 for squares of one size
    moved: tuple = ()  # (index of a pole in its part's tiling, vertex to which it was dragged)

    @property
    def is_chosen(self):
        """Whether poles, places for them, or a number of tiles are chosen."""
        return bool(self.tiles or self.moved) or self.allowed is not None or self.poles not in ("auto", 0)

    @property
    def made(self):
        """What of it decides how a tiling is made, before it is laid out."""
        return replace(self, quarters=0, pole_group="")


@dataclass(frozen=True)
class MapOptions:
    """What the redo panel changes."""

    forms: int = 8  # basis forms that get a map of their own, at most
    density: float = 1.0  # factor of UV lengths, about the middle of the UV square
    rotation: float = 0.0  # radians, counter-clockwise, of every part
    amounts: tuple = ()  # factor of each form's share in the main map; none means 1
    turns: tuple = ()  # radians, phase of each form's share in the main map
    margin: float = 0.02  # least distance between parts, in sides of the UV square
    main: str = AUTOMATIC  # what the main map is
    per_length: float = 0.0  # UV length for a length on the surface, at density 1; 0 fills the UV square
    tiling: TileOptions = TileOptions()

    @property
    def are_plain(self):
        """Whether nothing is chosen of the main map but what it is."""
        return self.density == 1 and self.rotation == 0 and not self.are_mixed

    @property
    def are_mixed(self):
        """Whether a dial of a form's share in the main map is turned."""
        return any(amount != 1 for amount in self.amounts) or any(turn != 0 for turn in self.turns)

    @property
    def arrangement(self):
        """The `holomorph.arrangement.Arrangement`."""
        lengths = self.density, self.rotation, self.margin, self.per_length
        return holomorph.arrangement.Arrangement(*lengths, self.tiling.quarters)
