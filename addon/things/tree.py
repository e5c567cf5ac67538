# SPDX-License-Identifier: GPL-3.0-or-later
"""Building trees of Geometry Nodes by formulas."""

import math
from dataclasses import dataclass, field

import bpy

from .. import compatibility

MADE_BY = "holomorph_nodes"  # custom property of a tree: its name and the version of how it is built


@dataclass(frozen=True)
class Dial:
    """An input of the modifier."""

    kind: str  # the end of the name of its socket
    settings: dict = field(default_factory=dict)


def number(default=0.0, low=-10.0, high=10.0):
    return Dial("Float", {"default_value": default, "min_value": low, "max_value": high})


def angle(low=-math.pi):
    return Dial("FloatAngle", {"min_value": low, "max_value": math.pi})


def made_once(name, version, dials, build):
    """The tree of this name and version, made by `build` where there is none."""
    made_by = f"{name} {version}"
    for found in bpy.data.node_groups:
        if found.library is None and found.get(MADE_BY) == made_by:
            return found
    tree = Tree(name, dials)
    tree.group[MADE_BY] = made_by
    build(tree)
    return tree.group


class Tree:
    """A new tree. Values in formulas are sockets, numbers, or tuples of three numbers."""

    def __init__(self, name, dials):
        """dials : {name: `Dial`} in the order in which the modifier shows them"""
        self.group = bpy.data.node_groups.new(name, "GeometryNodeTree")
        compatibility.add_socket(self.group, "Geometry", "NodeSocketGeometry", is_output=True)
        compatibility.add_socket(self.group, "Geometry", "NodeSocketGeometry")
        for title, dial in dials.items():
            socket = compatibility.add_socket(self.group, title, f"NodeSocket{dial.kind}")
            for setting, value in dial.settings.items():
                setattr(socket, setting, value)
        self._inputs, self._columns = self.group.nodes.new("NodeGroupInput"), 0
        self._output = self.group.nodes.new("NodeGroupOutput")

    def dial(self, name):
        return self._inputs.outputs[name]

    def finish(self, geometry):
        self.group.links.new(self._output.inputs[0], geometry)

    def node(self, kind, *values, named=None, **settings):
        """The first output of a new node; `values` are those of its inputs in their order, `named` others by name."""
        node = self.group.nodes.new(kind)
        self._columns += 1
        node.location = 200 * (self._columns % 12), -250 * (self._columns // 12)
        for name, value in settings.items():
            setattr(node, name, value)
        shown = [socket for socket in node.inputs if socket.enabled]
        pairs = list(zip(shown, values))
        pairs += [(next(s for s in shown if s.name == name), value) for name, value in (named or {}).items()]
        for socket, value in pairs:
            if isinstance(value, bpy.types.NodeSocket):
                self.group.links.new(socket, value)
            else:
                socket.default_value = value
        return next(socket for socket in node.outputs if socket.enabled)

    def attribute(self, name, kind="FLOAT"):
        """A field, also of the weights in a vertex group."""
        return self.node("GeometryNodeInputNamedAttribute", name, data_type=kind)

    def switch(self, condition, otherwise, then, kind):
        return self.node(
            "GeometryNodeSwitch", named={"Switch": condition, "False": otherwise, "True": then}, input_type=kind
        )

    def number(self, operation, *values, **settings):
        return self.node("ShaderNodeMath", *values, operation=operation, **settings)

    def vector(self, operation, *values):
        return self.node("ShaderNodeVectorMath", *values, operation=operation)

    def length(self, vector):
        return self._other("ShaderNodeVectorMath", "Value", vector, operation="LENGTH")

    def dot(self, a, b):
        return self._other("ShaderNodeVectorMath", "Value", a, b, operation="DOT_PRODUCT")

    def times(self, vector, factor):
        return self.node("ShaderNodeVectorMath", named={"Vector": vector, "Scale": factor}, operation="SCALE")

    def sum(self, *vectors):
        total = vectors[0]
        for vector in vectors[1:]:
            total = self.vector("ADD", total, vector)
        return total

    def parts(self, vector):
        return list(self.node("ShaderNodeSeparateXYZ", vector).node.outputs)

    def combined(self, weights, vectors):
        """The sum of vectors times weights."""
        return self.sum(*(self.times(vector, weight) for weight, vector in zip(weights, vectors)))

    def _other(self, kind, output, *values, **settings):
        return self.node(kind, *values, **settings).node.outputs[output]


# Attributes of points: where they are on the surface. See `parts.surface_values`.
POSITION = "position"
VERTICES = ("vertex_a", "vertex_b", "vertex_c")
CORNERS = ("corner_a", "corner_b", "corner_c")  # of the triangle, as the mesh numbers them
BARYCENTRIC = "barycentric"


class Followed:
    """The surface of the dial "Surface", at the points of a `tree.Tree`: modifiers that keep its vertices, such as an
    armature, move the points along.

    positions : of the three vertices of each point's triangle
    place : of the point
    side : 1, or -1 where the dial "Other Side" is on
    """

    def __init__(self, tree):
        surface = tree.node("GeometryNodeObjectInfo", tree.dial("Surface"), transform_space="RELATIVE").node
        self._tree, self._surface = tree, surface.outputs["Geometry"]
        self._vertices = [tree.attribute(name, "INT") for name in VERTICES]
        self._weights = tree.parts(tree.attribute(BARYCENTRIC, "FLOAT_VECTOR"))
        self.positions = self._at_vertices(tree.node("GeometryNodeInputPosition"), "FLOAT_VECTOR")
        self.place = tree.combined(self._weights, self.positions)
        self.side = tree.number("MULTIPLY_ADD", tree.dial("Other Side"), -2.0, 1.0)

    def normal(self):
        """The smooth normal, on that side."""
        tree, normals = self._tree, self._at_vertices(self._tree.node("GeometryNodeInputNormal"), "FLOAT_VECTOR")
        return tree.times(tree.vector("NORMALIZE", tree.combined(self._weights, normals)), self.side)

    def weight(self, group):
        """The weight in a vertex group, whose name is a socket."""
        tree, weights = self._tree, self._at_vertices(self._tree.attribute(group), "FLOAT")
        products = [tree.number("MULTIPLY", *pair) for pair in zip(self._weights, weights)]
        return tree.number("ADD", tree.number("ADD", *products[:2]), products[2])

    def uv(self, name):
        """The UV in a map whose name is a socket; modifiers keep its corners, too."""
        tree, field = self._tree, self._tree.attribute(name, "FLOAT_VECTOR")
        corners = [tree.attribute(corner, "INT") for corner in CORNERS]
        return tree.combined(self._weights, self._sampled(field, corners, "FLOAT_VECTOR", domain="CORNER"))

    def _at_vertices(self, field, kind):
        return self._sampled(field, self._vertices, kind)

    def _sampled(self, field, indices, kind, **settings):
        sample, settings = "GeometryNodeSampleIndex", settings | {"data_type": kind}
        return [self._tree.node(sample, self._surface, field, index, **settings) for index in indices]
