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

Meshes: Surface; Repairs, Cut, Refused; Quads; punch_holes, double_cover, symmetrised, cut_along;
ProgressiveMesh, LevelOfDetail.
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

from .core import starting  # noqa: F401

# What is imported as itself is public, for type checkers as well.
from .maps import arrangement as arrangement, report as report
from .quality import distortion as distortion
from .packing import layout as layout
from ._native import Cancelled as Cancelled, Error as Error, InvalidMesh as InvalidMesh, OutOfMemory as OutOfMemory
from ._native import SolverError as SolverError, TopologyError as TopologyError, __version__ as __version__
from .maps.automatic_map import automatic_map as automatic_map, automatic_maps as automatic_maps
from .maps.automatic_map import form_map as form_map, island_map as island_map
from .maps.automatic_structure import AnyStructure as AnyStructure, automatic_structure as automatic_structure
from .forms.structure import BoundedStructure as BoundedStructure, ConformalStructure as ConformalStructure
from .forms.structure import conformal_structure as conformal_structure
from .tiles.places import Cells as Cells, Lines as Lines, Places as Places
from .forms.certificate import Certificate as Certificate, PeriodMatrix as PeriodMatrix
from .mesh.checks import SOLVERS as SOLVERS
from .quality.distortion import CoarsePlace as CoarsePlace, coarse_places as coarse_places
from .maps.conformal_image import conformal_image as conformal_image
from .moduli.conformal_map import ConformalMap as ConformalMap, conformal_map as conformal_map
from .plane.cut import cut_along as cut_along
from .plane.disk import DiskMap as DiskMap, FreeBoundaryMap as FreeBoundaryMap, RectangleMap as RectangleMap
from .plane.disk import disk_map as disk_map, free_boundary_map as free_boundary_map, rectangle_map as rectangle_map
from .mesh.surgery import double_cover as double_cover, symmetrised as symmetrised
from .moduli.equivalence import Equivalence as Equivalence, conformally_equivalent as conformally_equivalent
from .forms.form_structure import FundamentalDomain as FundamentalDomain, Zeros as Zeros
from .tiles.height_image import height_image as height_image
from .mesh.surgery import punch_holes as punch_holes
from .moduli.symplectic import Automorphisms as Automorphisms, automorphisms as automorphisms
from .moduli.symplectic import igusa_invariants as igusa_invariants, siegel_reduction as siegel_reduction
from .moduli.symplectic import SiegelReduction as SiegelReduction
from .tiling.images import ImageLattice as ImageLattice, ImageTurns as ImageTurns, image_lattice as image_lattice
from .tiling.images import image_turns as image_turns
from .levels.levels import LevelOfDetail as LevelOfDetail
from .forms.log_map import PoleStructure as PoleStructure, log_map as log_map
from .maps.map import Map as Map
from .forms.narrow_bounds import Refinement as Refinement
from .packing.layout import Frame as Frame, frame as frame
from .levels.progressive import ProgressiveMesh as ProgressiveMesh
from .quality.quality import Quality as Quality
from .tiles.relief import Relief as Relief
from .mesh.quads import Quads as Quads
from .mesh.origin import Cut as Cut, Refused as Refused, Repairs as Repairs
from .forms.results import MemoryPlan as MemoryPlan, Residuals as Residuals, SolverReport as SolverReport
from .mesh.surface import Surface as Surface
from .tiles.tiled_surface import TiledSurface as TiledSurface
from .tiling.tiling import PlacedPoles as PlacedPoles, Rounding as Rounding, Tiler as Tiler, Tiling as Tiling
from .tiling.tiling import place_poles as place_poles
from .quality.verdicts import Seen as Seen, UNEVEN as UNEVEN, Verdict as Verdict, verdict as verdict

for _error in (Error, InvalidMesh, TopologyError, SolverError, OutOfMemory, Cancelled):
    _error.__module__ = "holomorph._native"


def __dir__() -> list[str]:
    """What completion shows: the public names, and not the rooms that they are from."""
    public = arrangement, distortion, layout, report
    names = {name for name, value in globals().items() if not isinstance(value, ModuleType) or value in public}
    return sorted(name for name in names - {"ModuleType"} if name[0] != "_") + ["__version__"]
