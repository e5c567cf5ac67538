"""Triangles as files for printers, in millimetres: bytes, the same for the same mesh on every run."""

import io
import zipfile

import numpy as np

from ..core import arrays
from . import formats

EPOCH = (1980, 1, 1, 0, 0, 0)  # the date of what is in a 3MF file, so that it does not depend on the clock
CONTENT_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>\n'
)
RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>\n'
)
MODEL = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<model unit="millimeter" xml:lang="en-US" '
    'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">\n'
    '<metadata name="Application">Holomorph</metadata>\n'
    '<resources><object id="1" type="model"><mesh>\n<vertices>\n',
    "</vertices>\n<triangles>\n",
    '</triangles>\n</mesh></object></resources>\n<build><item objectid="1"/></build>\n</model>\n',
)
HEADER = 80  # bytes of text that begin an STL file
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def content(path, mesh):
    """The bytes of a file of the kind that the path ends with. mesh : with vertices, triangles, corner_vertices,
    face_offsets and uv, as a `holomorph.Relief`. @throws ValueError for other endings"""
    return WRITERS[of_path(path)](mesh)


def of_path(path):
    """The name in `WRITERS`. @throws ValueError"""
    return formats.of_path(path, WRITERS)


def rounding(path, mesh):
    """By how much single precision moves points of a mesh that is far from the origin, in the file of this path."""
    if of_path(path) != "stl" or not arrays.near_origin(mesh.vertices)[1].any():
        return 0.0
    return float(np.abs(mesh.vertices.astype(np.float32) - mesh.vertices).max())


def stl(mesh):
    """Binary STL, which is in single precision: see `rounding`."""
    facets = np.zeros(len(mesh.triangles), FACET)
    facets["corners"] = mesh.vertices[mesh.triangles]
    a, b, c = np.moveaxis(facets["corners"].astype(np.float64), 1, 0)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    facets["normal"] = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    header = b"Holomorph, in millimetres".ljust(HEADER)
    return header + np.uint32(len(facets)).astype("<u4").tobytes() + facets.tobytes()


def three_mf(mesh):
    """3MF: a ZIP archive with the mesh as XML; coordinates have nine digits, relative to a place near them."""
    points, place = arrays.near_origin(mesh.vertices)
    vertices = formats.text_of('<vertex x="%.9g" y="%.9g" z="%.9g"/>\n', points)
    triangles = formats.text_of('<triangle v1="%d" v2="%d" v3="%d"/>\n', mesh.triangles)
    begin, between, end = MODEL
    if place.any():
        end = end.replace("<item ", '<item transform="1 0 0 0 1 0 0 0 1 {:.17g} {:.17g} {:.17g}" '.format(*place))
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (
            ("[Content_Types].xml", CONTENT_TYPES),
            ("_rels/.rels", RELATIONS),
            ("3D/3dmodel.model", begin + vertices + between + triangles + end),
        ):
            archive.writestr(zipfile.ZipInfo(name, EPOCH), text, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def obj(mesh):
    """OBJ with the map."""
    return formats.obj(mesh, mesh.uv)


WRITERS = {"stl": stl, "3mf": three_mf, "obj": obj}
