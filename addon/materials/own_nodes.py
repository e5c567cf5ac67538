# SPDX-License-Identifier: GPL-3.0-or-later
"""The node trees of materials that show the user's own textures: an image, or a copy of a material of theirs."""

from .nodes import HEIGHT_NODE, IMAGE_NODE, REPEATS_NODE, Tree

SHIFT_NODE = "Row Shift"
ROUGHNESS = 0.6
LEFT = -900  # of what is added to the user's nodes, from the leftmost of them, in the editor's units
TANGENTS = {"NORMAL_MAP", "TANGENT"}  # types of nodes whose vectors are those of a UV map
UNLINKED = {"TEX_IMAGE"}  # types of nodes that read the active UV map where nothing is linked


def build_image(material, map_name, is_attribute, repeats, own):
    """The image, laid on by the map."""
    tree = Tree.of(material)
    picture = tree.node("ShaderNodeTexImage", -360, 200, IMAGE_NODE, image=own.block)
    tree.link(_places(tree, tree.map_vector(map_name, is_attribute), repeats, own), picture.inputs["Vector"])
    tree.link(picture.outputs[0], tree.shader(ROUGHNESS).inputs["Base Color"])
    tree.show_in_solid_view(picture)


def adjust(material, repeats, own):
    """The image and numbers of what `build_image` made, where the user has not rebuilt them."""
    nodes = material.node_tree.nodes
    if IMAGE_NODE in nodes:
        nodes[IMAGE_NODE].image = own.block
    for name, value in _numbers(repeats, own).items():
        if name in nodes:
            nodes[name].outputs[0].default_value = value


def _numbers(repeats, own):
    return {REPEATS_NODE: repeats, HEIGHT_NODE: own.height, SHIFT_NODE: own.shift}


def redirect(tree, map_name, is_attribute, repeats, own):
    """Lets all nodes that read a UV map read this one, in the groups of the node tree as well, which are copied."""
    places, groups = None, {}
    for node in list(tree.nodes):
        if node.type == "GROUP" and node.node_tree is not None:
            if node.node_tree not in groups:
                groups[node.node_tree] = node.node_tree.copy()
                redirect(groups[node.node_tree], map_name, is_attribute, repeats, own)
            node.node_tree = groups[node.node_tree]
        elif node.type in TANGENTS:
            node.uv_map = map_name
    for socket in _reading(tree):
        if places is None:
            places = _places_in(tree, map_name, is_attribute, repeats, own)
        tree.links.new(places, socket)


def groups(tree):
    """The node trees of the groups in a tree that `redirect` was given."""
    inside = {node.node_tree for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None}
    return inside.union(*map(groups, inside))


def only_images_read(tree):
    """Whether UVs go to images only, in groups of the tree as well."""
    inside = [node.node_tree for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None]
    own = all(link.to_node.type == "TEX_IMAGE" for link in tree.links if _gives_uvs(link))
    return own and all(map(only_images_read, inside))


def _reading(tree):
    """The inputs that take UVs: of links from nodes that give some, and of images without a link."""
    given = [link.to_socket for link in tree.links if _gives_uvs(link)]
    images = [node.inputs["Vector"] for node in tree.nodes if node.type in UNLINKED]
    return given + [socket for socket in images if not socket.is_linked]


def _gives_uvs(link):
    node = link.from_node
    return node.type == "UVMAP" or (node.type == "TEX_COORD" and link.from_socket.name == "UV")


def _places_in(tree, map_name, is_attribute, repeats, own):
    """The socket of `_places`, left of the user's nodes."""
    added = Tree(tree, min(node.location.x for node in tree.nodes) + LEFT)
    return _places(added, added.map_vector(map_name, is_attribute, label=""), repeats, own)


def _places(tree, vector, repeats, own):
    """The socket of UVs in images: v over their height, and each row of images moved beside the one below it."""
    sockets = []
    for row, (name, value) in enumerate(_numbers(repeats, own).items()):
        sockets.append(tree.node("ShaderNodeValue", -900, -120 - 100 * row, name).outputs[0])
        sockets[-1].default_value = value
    times, height, shift = sockets
    apart = tree.node("ShaderNodeSeparateXYZ", -740, 100)
    tree.link(tree.scaled(vector, times, -820, 200), apart.inputs[0])
    up = tree.number("DIVIDE", apart.outputs["Y"], height, x=-680)
    row = tree.number("FLOOR", up, x=-620)
    moved = tree.number("MULTIPLY", row, shift, x=-560)
    along = tree.number("SUBTRACT", apart.outputs["X"], moved, x=-500)
    places = tree.node("ShaderNodeCombineXYZ", -440, 100)
    for value, name in ((along, "X"), (up, "Y")):
        tree.link(value, places.inputs[name])
    return places.outputs[0]
