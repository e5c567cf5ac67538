# SPDX-License-Identifier: GPL-3.0-or-later
"""Genus and boundary loops of the parts of a mesh in Blender."""

import bmesh


def part_topologies(mesh):
    """(genus, boundary loops) of each connected part, sorted; raises on a mesh that is not a manifold."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    unseen, found = set(bm.verts), []
    while unseen:
        part = connected({unseen.pop()}, lambda v: v.link_edges)
        unseen -= part
        edges = {e for v in part for e in v.link_edges}
        faces = {f for v in part for f in v.link_faces}
        boundary = [e for e in edges if e.is_boundary]
        fans_whole = all(sum(e.is_boundary for e in v.link_edges) in (0, 2) for v in part)
        if any(len(e.link_faces) not in (1, 2) for e in edges) or not fans_whole:
            raise RuntimeError(f"{mesh.name} is not a manifold")
        loops, rest = 0, {v for e in boundary for v in e.verts}
        while rest:
            rest -= connected({rest.pop()}, lambda v: [e for e in v.link_edges if e.is_boundary])
            loops += 1
        found.append(((2 - loops - (len(part) - len(edges) + len(faces))) // 2, loops))
    bm.free()
    return sorted(found)


def connected(front, edges_of):
    """The vertices that the edges lead to from those in `front`."""
    seen = set()
    while front:
        vertex = front.pop()
        seen.add(vertex)
        front |= {e.other_vert(vertex) for e in edges_of(vertex)} - seen
    return seen
