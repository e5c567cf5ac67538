# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry Nodes that find points again on a surface that has been deformed."""

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
