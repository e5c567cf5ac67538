# SPDX-License-Identifier: GPL-3.0-or-later
"""The Geometry Nodes that put a piece on every point, where the surface is now."""

from .tree import Dial, Followed, angle, made_once, number

NAME = "Holomorphic Geometry on Tiling"
VERSION = 2  # of what follows
ANY = 1_000_000  # more pieces than a collection has: which one is counted on from the first again
LEAST_SHOWN = 0.02  # of its size: what has shrunk below is left out
TINY = 1e-6

# Attributes of the points, beside those of `following`; see `points.found`.
ROW_STEP, COLUMN_STEP = "along_row", "across_rows"
RELATIVE_SIZE, POLE_DISTANCE, LEANING, PIECE_INDEX = "relative_size", "pole_distance", "leaning", "piece_index"
# Those that pieces get, too.
SIZE, NORMAL, TANGENT = "size", "normal_of_surface", "tangent"


DIALS = {
    "Surface": Dial("Object"),
    "Object": Dial("Object"),
    "Collection": Dial("Collection"),
    "By Chance": Dial("Bool", {"default_value": True}),
    "Size": number(1.0, 0.0),
    "Fit": number(1.0, 0.0, 1.0),
    "Along Rows": number(),
    "Across Rows": number(),
    "Height": number(),
    "Rotation": angle(),
    "Tilt": angle(),
    "Rows Lean in Turn": Dial("Bool"),
    "Random Size": number(0.0, 0.0, 1.0),
    "Random Tilt": angle(0.0),
    "Seed": Dial("Int"),
    "Vertex Group": Dial("String"),
    "Image": Dial("Image"),
    "Image Masks": Dial("Bool"),
    "Image Chooses": Dial("Bool"),
    "UV Map of Image": Dial("String"),
    "UV Units of Image": number(1.0, 0.001, 1000.0),
    "Least Size": number(0.4, 0.0),
    "Most Size": number(1.5, 0.0),
    "Around Poles": number(0.5, 0.0),
    "Other Side": Dial("Bool"),
}


def group():
    return made_once(NAME, VERSION, DIALS, _build)


def _build(tree):
    surface = Followed(tree)
    normal = surface.normal()
    row, size = _row_and_size(tree, surface.positions)
    stretch = tree.number("DIVIDE", tree.length(row), tree.number("MAXIMUM", size, TINY))
    along = tree.vector("NORMALIZE", tree.vector("SUBTRACT", row, tree.times(normal, tree.dot(row, normal))))
    along = tree.times(along, surface.side)  # so that pieces are upright on both sides
    across = tree.vector("CROSS_PRODUCT", normal, along)
    limited = tree.number("DIVIDE", tree.dial("Most Size"), tree.number("MAXIMUM", tree.attribute(RELATIVE_SIZE), TINY))
    size = tree.number("MULTIPLY", size, tree.number("MINIMUM", limited, 1.0))
    offset = [tree.dial(name) for name in ("Along Rows", "Across Rows", "Height")]
    moved = tree.times(tree.combined(offset, [along, across, normal]), size)
    points = tree.node(
        "GeometryNodeSetPosition", tree.dial("Geometry"), named={"Position": tree.vector("ADD", surface.place, moved)}
    )
    for name, value, kind in (
        (SIZE, size, "FLOAT"),
        (NORMAL, normal, "FLOAT_VECTOR"),
        (TANGENT, along, "FLOAT_VECTOR"),
    ):
        points = _stored(tree, points, name, value, kind)
    value = _image_value(tree, surface)
    part = tree.number("MULTIPLY", _part_of_size(tree, surface), _where(tree, "Image Masks", value))
    rotation = _rotation(tree, along, across, normal)
    scale = _scale(tree, tree.number("MULTIPLY", size, part), stretch)
    tree.finish(_instances(tree, points, part, rotation, scale, value))


def _row_and_size(tree, positions):
    """The width of a cell along its row as a vector, and the root of the area of a square of that width."""
    edges = [tree.vector("SUBTRACT", positions[k], positions[0]) for k in (1, 2)]
    row, column = (
        tree.combined(tree.parts(tree.attribute(name, "FLOAT_VECTOR"))[:2], edges) for name in (ROW_STEP, COLUMN_STEP)
    )
    return row, tree.number("SQRT", tree.length(tree.vector("CROSS_PRODUCT", row, column)))


def _part_of_size(tree, surface):
    """What is left of each piece's size, from 0 to 1: by the vertex group, where it is small, at poles, by chance."""
    least = _faded(tree, tree.attribute(RELATIVE_SIZE), tree.dial("Least Size"))
    poles = _faded(tree, tree.attribute(POLE_DISTANCE), tree.dial("Around Poles"))
    mask = surface.weight(tree.dial("Vertex Group"))
    is_named = tree.number("MINIMUM", tree.node("FunctionNodeStringLength", tree.dial("Vertex Group")), 1.0)
    mask = tree.number("ADD", tree.number("MULTIPLY", is_named, mask), tree.number("SUBTRACT", 1.0, is_named))
    chance = tree.number("MULTIPLY", _chance(tree), tree.dial("Random Size"))
    part = tree.number("SUBTRACT", 1.0, chance)
    for factor in (least, poles, mask):
        part = tree.number("MULTIPLY", part, factor)
    return part


def _image_value(tree, surface):
    """The brightness of the image at each place, from 0 to 1."""
    unit = tree.number("DIVIDE", 1.0, tree.dial("UV Units of Image"))
    place = tree.times(surface.uv(tree.dial("UV Map of Image")), unit)
    color = tree.node("GeometryNodeImageTexture", named={"Image": tree.dial("Image"), "Vector": place})
    return tree.number("ADD", color, 0.0, use_clamp=True)


def _where(tree, dial, value):
    """The value where the dial is on, else 1."""
    return tree.switch(tree.dial(dial), 1.0, value, "FLOAT")


def _faded(tree, value, threshold):
    """1 above the threshold, 0 below half of it."""
    half = tree.number("MULTIPLY", threshold, 0.5)
    above = tree.number("SUBTRACT", value, half)
    return tree.number("DIVIDE", above, tree.number("MAXIMUM", half, TINY), use_clamp=True)


def _chance(tree, offset=0, low=0.0, high=1.0):
    seed = tree.number("ADD", tree.dial("Seed"), float(offset))
    return tree.node("FunctionNodeRandomValue", named={"Min": low, "Max": high, "Seed": seed})


def _rotation(tree, along, across, normal):
    along, across = _turned(tree, along, across, tree.dial("Rotation"))
    in_turn = tree.number("SUBTRACT", tree.attribute(LEANING), 1.0)
    leaning = tree.number("MULTIPLY_ADD", tree.dial("Rows Lean in Turn"), in_turn, 1.0)
    chance = tree.number("MULTIPLY", _chance(tree, 1, -1.0, 1.0), tree.dial("Random Tilt"))
    tilt = tree.number("MULTIPLY_ADD", tree.dial("Tilt"), leaning, chance)
    up, _ = _turned(tree, normal, across, tilt)
    rotation = tree.node("FunctionNodeAlignEulerToVector", named={"Vector": along}, axis="X")
    named = {"Rotation": rotation, "Vector": up}
    return tree.node("FunctionNodeAlignEulerToVector", named=named, axis="Z", pivot_axis="X")


def _turned(tree, a, b, angle):
    """Two orthogonal unit vectors turned in their plane, from a to b."""
    cosine, sine = tree.number("COSINE", angle), tree.number("SINE", angle)
    back = tree.number("MULTIPLY", sine, -1.0)
    return tree.combined((cosine, sine), (a, b)), tree.combined((back, cosine), (a, b))


def _scale(tree, size, stretch):
    """The scale of a piece. With Fit, pieces are as wide and as high as their cells, which a tiling stretches a little:
    so they keep covering it, and rings of mail keep holding each other."""
    size = tree.number("MULTIPLY", size, tree.dial("Size"))
    wide = tree.number("POWER", stretch, tree.dial("Fit"))
    sizes = tree.number("MULTIPLY", size, wide), tree.number("DIVIDE", size, wide), size
    return tree.node("ShaderNodeCombineXYZ", *sizes)


def _stored(tree, points, name, value, kind):
    named = {"Name": name, "Value": value}
    return tree.node("GeometryNodeStoreNamedAttribute", points, named=named, data_type=kind, domain="POINT")


def _by_value(tree, pieces, value):
    """The place in a row of instances."""
    size = tree.node("GeometryNodeAttributeDomainSize", pieces, component="INSTANCES").node
    count = size.outputs["Instance Count"]
    last = tree.number("SUBTRACT", count, 1.0)
    return tree.number("MINIMUM", tree.number("FLOOR", tree.number("MULTIPLY", value, count)), last)


def _instances(tree, points, part, rotation, scale, value):
    """The object and those of the collection are chosen from together: one of the two is empty. By the value the first
    is chosen from 0 on, the last up to 1."""
    one = tree.node("GeometryNodeObjectInfo", tree.dial("Object"), True, transform_space="ORIGINAL").node
    several = tree.node("GeometryNodeCollectionInfo", tree.dial("Collection"), True, True)
    pieces = tree.node("GeometryNodeJoinGeometry")
    for geometry in (one.outputs["Geometry"], several):
        tree.group.links.new(pieces.node.inputs[0], geometry)
    chance = tree.node(
        "FunctionNodeRandomValue", data_type="INT", named={"Min": 0, "Max": ANY, "Seed": tree.dial("Seed")}
    )
    in_turn = tree.attribute(PIECE_INDEX, "INT")
    index = tree.switch(tree.dial("By Chance"), in_turn, chance, "INT")
    index = tree.switch(tree.dial("Image Chooses"), index, _by_value(tree, pieces, value), "INT")
    is_shown = tree.node("FunctionNodeCompare", part, LEAST_SHOWN, data_type="FLOAT", operation="GREATER_THAN")
    return tree.node(
        "GeometryNodeInstanceOnPoints",
        named={
            "Points": points,
            "Selection": is_shown,
            "Instance": pieces,
            "Pick Instance": True,
            "Instance Index": index,
            "Rotation": rotation,
            "Scale": scale,
        },
    )
