"""Conformal structures of surfaces: harmonic and holomorphic one-forms, period matrices, seamless UV maps.

>>> import holomorph
>>> surface = holomorph.Surface.read("kitten.obj")
>>> structure = holomorph.conformal_structure(surface)
>>> uv = structure.uv(structure.balanced_coefficients())

Conventions. A one-form is one real number per edge, for the direction from the lower to the higher vertex index. Forms
are rows. A canonical basis has a_i . b_j = delta_ij; the holomorphic basis has period 1 over a_j for theta_j and 0 over
the other a; the period matrix is its integrals over the b. `*(p dx + q dy) = p dy - q dx`, so `dx + i *dx = dz`.

Method: Gu, Wang, Yau, Multiresolution Computation of Conformal Structures of Surfaces (2003).
"""

from . import starting  # noqa: I001, F401 -- before NumPy is loaded
from . import arrangement, distortion, layout, report
from ._native import Cancelled, Error, InvalidMesh, OutOfMemory, SolverError, TopologyError, __version__
from .automatic_map import automatic_map
from .automatic_maps import automatic_maps
from .automatic_structure import AnyStructure, automatic_structure
from .bounded import BoundedStructure
from .cells import Cells
from .certificate import Certificate
from .checks import SOLVERS
from .closed import ConformalStructure
from .coarse_places import CoarsePlace, coarse_places
from .cones import cut_to_cones
from .conformal_image import conformal_image
from .conformal_map import ConformalMap, conformal_map
from .curve_periods import curve_period_matrix
from .cut import cut_along
from .disk import disk_map, free_boundary_map, rectangle_map, triangle_map
from .disk_islands import disk_islands
from .double import double_cover, symmetrised
from .equivalence import Equivalence, conformally_equivalent
from .fundamental_domain import FundamentalDomain
from .height_image import height_image
from .holes import punch_holes
from .igusa import IgusaInvariants, igusa_invariants
from .image_lattice import ImageLattice, image_lattice
from .island_map import Islands, island_map
from .islands import islands
from .levels import LevelOfDetail
from .lines import Lines
from .log_map import log_map
from .map import Map, form_map
from .mixed import Mixed
from .narrow_bounds import Refinement
from .placement import Frame, frame, place
from .places import Places
from .plane_maps import DiskMap, FreeBoundaryMap, RectangleMap, TriangleMap
from .pole_structure import PoleStructure
from .progressive import ProgressiveMesh
from .quality import Quality
from .relief import Relief
from .repairs import Cut, Refused, Repairs
from .period_matrix import PeriodMatrix
from .siegel import SiegelReduction, siegel_reduction
from .solver_report import MemoryPlan, Residuals, SolverReport
from .structure import conformal_structure
from .surface import Surface
from .symmetries import Automorphisms, automorphisms
from .theta_constants import Hyperelliptic, hyperelliptic
from .tiled_surface import TiledSurface
from .tiling import Tiler, place_poles
from .tilings import PlacedPoles, Rounding, Tiling
from .verdicts import UNEVEN, Verdict, overall, verdict
from .zeros import Zeros

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
    "Hyperelliptic",
    "IgusaInvariants",
    "ImageLattice",
    "Islands",
    "InvalidMesh",
    "LevelOfDetail",
    "Lines",
    "Map",
    "MemoryPlan",
    "Mixed",
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
    "SiegelReduction",
    "SolverError",
    "SolverReport",
    "Surface",
    "TiledSurface",
    "Tiler",
    "Tiling",
    "TopologyError",
    "TriangleMap",
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
    "curve_period_matrix",
    "cut_along",
    "cut_to_cones",
    "disk_islands",
    "disk_map",
    "distortion",
    "double_cover",
    "form_map",
    "frame",
    "free_boundary_map",
    "height_image",
    "hyperelliptic",
    "igusa_invariants",
    "image_lattice",
    "island_map",
    "islands",
    "layout",
    "log_map",
    "overall",
    "place",
    "place_poles",
    "punch_holes",
    "rectangle_map",
    "report",
    "siegel_reduction",
    "symmetrised",
    "triangle_map",
    "verdict",
]
