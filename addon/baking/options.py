# SPDX-License-Identifier: GPL-3.0-or-later
"""What is baked, and into which images."""

from dataclasses import dataclass

EACH, ONE, UDIM = "EACH", "ONE", "UDIM"  # an image for each object, one for all, one with a tile for each
COLOUR, ROUGHNESS, METALLIC, HEIGHT, NORMAL = "COLOUR", "ROUGHNESS", "METALLIC", "HEIGHT", "NORMAL"
CHANNELS = (COLOUR, ROUGHNESS, METALLIC, HEIGHT, NORMAL)
USUAL_CHANNELS = frozenset({COLOUR, ROUGHNESS, NORMAL})
USUAL_SIDE = 2048  # texels of an image's side where no texels per metre are asked for
LEAST_SIDE, MOST_SIDE = 16, 16384


@dataclass(frozen=True)
class BakeOptions:
    """The dials of a bake."""

    channels: frozenset = USUAL_CHANNELS
    images: str = EACH
    texels: float = 0.0  # for a metre of the surface; 0: images have the usual side
    margin: int = 8  # texels around islands that show what their border shows
    folder: str = ""  # where images are saved; "" packs them into the file

    @property
    def room(self):
        """Texels that belong to each island around it: a margin, and one that rounding may take of it."""
        return self.margin + 1
