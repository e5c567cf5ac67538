"""Conformal structures of surfaces: harmonic and holomorphic one-forms, period matrices, seamless UV maps.

>>> import holomorph
>>> surface = holomorph.Surface.read("examples/pretzel.obj")
>>> structure = holomorph.conformal_structure(surface)
>>> uv = structure.uv(structure.balanced_coefficients())
>>> print(structure.quality(uv).verdict.sentence)
Uneven (squares of 1 to 2.1)

Conventions. A one-form is one real number per edge, for the direction from the lower to the higher vertex index. Forms
are rows. A canonical basis has a_i . b_j = delta_ij; the holomorphic basis has period 1 over a_j for theta_j and 0 over
the other a; the period matrix is its integrals over the b. `*(p dx + q dy) = p dy - q dx`, so `dx + i *dx = dz`.

Method: Gu, Wang, Yau, Multiresolution Computation of Conformal Structures of Surfaces (2003).

Contents. help(holomorph.Surface) tells more, and so for each name.

Meshes: Surface; Repairs, Cut, Refused; punch_holes, double_cover, symmetrised, cut_along; ProgressiveMesh,
LevelOfDetail.
The map for a mesh: automatic_map, automatic_maps, Map; form_map, island_map; arrangement, layout,
Frame, frame; report.
Its quality: Verdict, verdict, Seen, UNEVEN, Quality, distortion; CoarsePlace, coarse_places.
Structures: conformal_structure, automatic_structure, AnyStructure, SOLVERS; ConformalStructure, BoundedStructure,
PoleStructure, log_map, Zeros, FundamentalDomain, PeriodMatrix; Certificate, Refinement; MemoryPlan, SolverReport,
Residuals.
Maps to the plane and the sphere: disk_map, DiskMap, rectangle_map, RectangleMap,
free_boundary_map, FreeBoundaryMap, conformal_image.
Tilings: Tiler, Tiling, Rounding, place_poles, PlacedPoles; TiledSurface, Places, Lines, Cells, Relief; height_image,
image_lattice, ImageLattice, image_turns, ImageTurns.
Surfaces compared: conformally_equivalent, Equivalence, conformal_map, ConformalMap, automorphisms, Automorphisms,
siegel_reduction, SiegelReduction, igusa_invariants.
Errors: Error, and its kinds InvalidMesh, TopologyError, SolverError, OutOfMemory, Cancelled.
"""

from types import ModuleType  # noqa: I001 -- `starting` comes before what loads NumPy
from typing import TYPE_CHECKING

from .core import starting  # noqa: F401
from .maps import arrangement, report
from .quality import distortion
from .packing import layout
from ._native import Cancelled, Error, InvalidMesh, OutOfMemory, SolverError, TopologyError, __version__
from .maps.automatic_map import automatic_map, automatic_maps
from .maps.automatic_structure import AnyStructure, automatic_structure
from .forms.structure import BoundedStructure
from .tiles.places import Cells
from .forms.certificate import Certificate
from .mesh.checks import SOLVERS
from .forms.structure import ConformalStructure
from .quality.distortion import CoarsePlace, coarse_places
from .maps.conformal_image import conformal_image
from .moduli.conformal_map import ConformalMap, conformal_map
from .plane.cut import cut_along
from .plane.disk import disk_map, free_boundary_map, rectangle_map
from .mesh.double import double_cover, symmetrised
from .moduli.equivalence import Equivalence, conformally_equivalent
from .forms.form_structure import FundamentalDomain
from .tiles.height_image import height_image
from .mesh.holes import punch_holes
from .moduli.siegel import igusa_invariants
from .tiling.images import ImageLattice, image_lattice
from .tiling.images import ImageTurns, image_turns
from .levels.levels import LevelOfDetail
from .forms.log_map import log_map
from .maps.map import Map, form_map, island_map
from .forms.narrow_bounds import Refinement
from .packing.layout import Frame, frame
from .tiles.places import Lines, Places
from .plane.disk import DiskMap, FreeBoundaryMap, RectangleMap
from .forms.log_map import PoleStructure
from .levels.progressive import ProgressiveMesh
from .quality.quality import Quality
from .tiles.relief import Relief
from .mesh.origin import Cut, Refused, Repairs
from .forms.certificate import PeriodMatrix
from .moduli.siegel import SiegelReduction, siegel_reduction
from .forms.results import MemoryPlan, Residuals, SolverReport
from .forms.structure import conformal_structure
from .mesh.surface import Surface
from .moduli.symmetries import Automorphisms, automorphisms
from .tiles.tiled_surface import TiledSurface
from .tiling.tiling import Tiler, place_poles
from .tiling.tiling import PlacedPoles, Rounding, Tiling
from .quality.verdicts import UNEVEN, Seen, Verdict, verdict
from .forms.form_structure import Zeros

if TYPE_CHECKING:  # at run time, help() would print all that it names in full, and what says that it is of this module
    __all__ = [
        "AnyStructure",
        "Automorphisms",
        "BoundedStructure",
        "Cancelled",
        "Cells",
        "Certificate",
        "CoarsePlace",
        "ConformalMap",
        "ConformalStructure",
        "Cut",
        "DiskMap",
        "Equivalence",
        "Error",
        "Frame",
        "FreeBoundaryMap",
        "FundamentalDomain",
        "ImageLattice",
        "ImageTurns",
        "InvalidMesh",
        "LevelOfDetail",
        "Lines",
        "Map",
        "MemoryPlan",
        "OutOfMemory",
        "ProgressiveMesh",
        "PeriodMatrix",
        "PlacedPoles",
        "Places",
        "PoleStructure",
        "Quality",
        "RectangleMap",
        "Refinement",
        "Refused",
        "Relief",
        "Repairs",
        "Residuals",
        "Rounding",
        "SOLVERS",
        "Seen",
        "SiegelReduction",
        "SolverError",
        "SolverReport",
        "Surface",
        "TiledSurface",
        "Tiler",
        "Tiling",
        "TopologyError",
        "UNEVEN",
        "Verdict",
        "Zeros",
        "__version__",
        "arrangement",
        "automatic_map",
        "automatic_maps",
        "automatic_structure",
        "automorphisms",
        "coarse_places",
        "conformal_image",
        "conformal_map",
        "conformal_structure",
        "conformally_equivalent",
        "cut_along",
        "disk_map",
        "distortion",
        "double_cover",
        "form_map",
        "frame",
        "free_boundary_map",
        "height_image",
        "igusa_invariants",
        "image_lattice",
        "image_turns",
        "island_map",
        "layout",
        "log_map",
        "place_poles",
        "punch_holes",
        "rectangle_map",
        "report",
        "siegel_reduction",
        "symmetrised",
        "verdict",
    ]
for _error in (Error, InvalidMesh, TopologyError, SolverError, OutOfMemory, Cancelled):
    _error.__module__ = "holomorph._native"


def __dir__() -> list[str]:
    """What completion shows: the public names, and not the rooms that they are from."""
    public = arrangement, distortion, layout, report
    names = {name for name, value in globals().items() if not isinstance(value, ModuleType) or value in public}
    return sorted(name for name in names - {"ModuleType", "TYPE_CHECKING"} if name[0] != "_") + ["__version__"]
