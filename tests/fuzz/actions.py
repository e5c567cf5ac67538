"""What is asked of a structure. Each may end in an error of the library; what it returns is checked."""

import holomorph
import numpy as np
import oracle
from holomorph import (
    BoundedStructure,
    ConformalStructure,
    DiskMap,
    PoleStructure,
    ProgressiveMesh,
    Tiler,
    TopologyError,
)


def first_map(structure, _):
    """Takes the first form alone, which costs no search."""
    kind = getattr(structure, "coefficient_type", np.float64)
    count = structure.holomorphic_forms.shape[0]
    return oracle.check_map(structure, np.eye(1, count, dtype=kind)[0] if count else ())


def balanced(structure, _):
    coefficients = structure.balanced_coefficients()
    oracle.check_finite("coefficients", coefficients)
    oracle.check_map(structure, coefficients)


def forms(structure, _):
    """NaN is said of edges at a pole alone."""
    values = structure.holomorphic_forms
    edges = structure.edges
    at_poles = np.isin(edges, structure.poles if isinstance(structure, PoleStructure) else []).any(axis=1)
    oracle.check_finite("forms", values[:, ~at_poles])
    if len(values):
        star = structure.averaged_star(np.where(at_poles, 0.0, values[0].real))
        oracle.check_finite("averaged_star", star)
    assert len(structure.seams) == 0 or structure.seams.max() < len(edges)


def plane(structure, _):
    """Maps to the disk and the sphere stay there."""
    if isinstance(structure, DiskMap):
        used = structure._component.vertex_index if structure._component is not structure.surface else slice(None)
        z = structure.disk_map()[used]
        oracle.check_finite("disk_map", z)
        assert np.abs(z).max() <= 1 + 1e-9, "the disk map leaves the disk"
    if not isinstance(structure, PoleStructure):
        raise TopologyError("no sphere")
    points = structure.sphere_map()
    points = points[structure._component.vertex_index] if structure._component is not structure.surface else points
    oracle.check_finite("sphere_map", points)
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 1e-9, "the sphere map leaves the sphere"


def tiling(structure, options):
    """With `options` of `Tiler` and of `tile`, and a pole elsewhere."""
    made = Tiler(structure.surface, threads=1, **options.get("tiler", {}))
    tilings = [made.tile(**options.get("tile", {"tiles": 60}))]
    if len(tilings[0].poles):
        tilings.append(made.move_poles(tilings[0], {0: int(tilings[0].poles[-1])}))
    for result in tilings:
        oracle.check_finite("the uv of a tiling", result.uv)
        oracle.check_finite("residues", result.residues)
        assert not np.isnan([result.added_distortion, result.beltrami_rms, result.tiles, result.size_range]).any()


def levels(structure, _):
    mesh = ProgressiveMesh(structure.surface, order="independent")
    uv = structure.uv(structure.balanced_coefficients()) if structure.surface.face_offsets[-1] < 60 else None
    if uv is None:
        return
    for level in mesh.levels_of_detail(uv, [0, 12], harmonic=len(mesh.splits) % 2 == 0, threads=1):
        oracle.check_surface(level.surface)
        oracle.check_finite("the uv of a level", level.uv)


def level_structure(structure, _):
    mesh = ProgressiveMesh(structure.surface)
    oracle.check_surface(mesh.restore())
    oracle.check_invariants(mesh.conformal_structure(16, threads=1))


def report(structure, _):
    made = holomorph.report.component_report(structure._component, structure)
    assert made["done"]


def double(structure, _):
    """The double is closed, of genus 2g + b - 1."""
    surface = structure._component
    doubled = holomorph.double_cover(surface)
    assert doubled.boundary_count == 0
    assert doubled.genus == 2 * surface.genus + surface.boundary_count - 1
    oracle.check_invariants(holomorph.conformal_structure(doubled, threads=1))


def paper(structure, _):
    """All triangles are in D, around which the boundary is closed; a hole is one boundary loop more."""
    if not isinstance(structure, (ConformalStructure, BoundedStructure)):
        return
    domain, classes = structure.fundamental_domain, structure.integer_classes
    count = len(structure._component.triangles)
    assert (np.sort(domain.faces) == np.arange(count)).all(), "D has not each triangle once"
    assert (domain.boundary[:, 1] == np.roll(domain.boundary[:, 0], -1)).all(), "the boundary of D is not closed"
    oracle.check_finite("weights", structure.edge_weights)
    assert structure.vectors(classes[0]).shape == (count, 3)
    surface = structure._component
    punched = holomorph.punch_holes(surface, [len(surface.vertices) // 2])
    assert (punched.genus, punched.boundary_count) == (surface.genus, surface.boundary_count + 1)


ACTIONS = {
    "map": first_map,
    "balanced": balanced,
    "forms": forms,
    "plane": plane,
    "tiling": tiling,
    "levels": levels,
    "level structure": level_structure,
    "report": report,
    "double": double,
    "paper": paper,
}
# How often each is taken: the slow ones seldom.
SHARES = {
    "map": 0.7,
    "balanced": 0.04,
    "forms": 0.2,
    "plane": 0.3,
    "tiling": 0.02,
    "levels": 0.03,
    "level structure": 0.05,
    "report": 0.02,
    "double": 0.05,
    "paper": 0.1,
}


def chosen(random, count):
    """The names of some, and options of tilings on a mesh of `count` vertices."""
    names = [name for name, share in SHARES.items() if random.random() < share]
    return {"actions": names, "tiling": tiling_options(random, count) if "tiling" in names else {}}


def tiling_options(random, count):
    """Options of `tiling`, on a mesh of `count` vertices; a few of them wrong."""
    drawn = {
        "poles": (0, 1, 2, 3, [random.randrange(count) for _ in range(3)], "auto", "many", None),
        "boundary": ("free", "straight", "automatic", "round"),
        "tiles": (60, 1e4, 1e-3, 1e300, -1, "many"),
        "lattice": ("brick", "hex", [[1, 0.5], [0, 1e-3]], [[1e200, 0], [0, 1]], [[1, 2], [2, 4]], "round"),
        "direction": ([0, 0, 1], [1e300, 1, -1e300], [1e-300, 0, 0], [0, 0, 0], "up"),
        "turn": (0.3, 1e300, float("nan")),
        "max_turn": (0.0, 1.0, -1.0, 1e300, float("nan")),
        "max_added": (1.0, 1.5, 0.5, float("nan")),
    }
    chosen = {name: random.choice(values) for name, values in drawn.items() if random.random() < 0.3}
    own = {name: chosen.pop(name) for name in ("poles", "boundary") if name in chosen}
    return {"tiler": own, "tile": chosen}
