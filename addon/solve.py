# SPDX-License-Identifier: GPL-3.0-or-later
"""From polygons to conformal structures, component by component. No bpy here: it runs in a worker thread."""

import time
from dataclasses import dataclass, field

from . import native

UV_START = 0.6  # fraction of the work after which the potentials of the maps are solved for


@dataclass(frozen=True)
class SolvedComponent:
    """A connected part of the object; `structure` is None where it was skipped, and `reason` says why."""

    surface: object
    structure: object | None
    balanced: object | None  # (g,) complex coefficients, UV area 1
    reason: str
    frames: dict = field(default_factory=dict, compare=False)  # middle and area of each map
    qualities: dict = field(default_factory=dict, compare=False)  # of main maps, by their dials

    @property
    def form_count(self):
        return 0 if self.structure is None else self.surface.genus


@dataclass(frozen=True)
class SolvedObject:
    """The components of one object in the library's order, and the repairs of the whole."""

    surface: object
    components: tuple
    seconds: float

    @property
    def form_count(self):
        """The largest number of forms among the components; 0 if every one was skipped."""
        return max((c.form_count for c in self.components), default=0)

    @property
    def size(self):
        """About how many doubles the kept structures hold: the harmonic forms and the potentials."""
        return sum(4 * c.form_count * len(c.structure.edges) for c in self.components if c.structure)


def reason_to_skip(component):
    """Why a component gets no map, or an empty string: closed surfaces of genus at least 1 are treated."""
    genus, boundaries = component.genus, component.boundary_count
    if boundaries:
        loops = "boundary loop" if boundaries == 1 else "boundary loops"
        return f"it is open ({boundaries} {loops}, genus {genus}); only closed surfaces are treated"
    if genus == 0:
        return "it has no handle (genus 0, like a sphere), and only forms on handles are computed"
    return ""


def solve(polygons, progress=None):
    """The conformal structure of every closed component with a handle.

    progress(fraction, stage) returning False cancels. Raises `holomorph.Error`.
    """
    holomorph = native.load()
    start = time.perf_counter()
    surface = holomorph.Surface.from_polygons(polygons.vertices, polygons.corner_vertices, polygons.face_offsets)
    parts = surface.components
    total = max(sum(len(p.face_index) for p in parts), 1)
    solved, done = [], 0
    for part in parts:
        share = len(part.face_index) / total
        solved.append(_solve_component(holomorph, part, _scaled(progress, done, share)))
        done += share
    return SolvedObject(surface, tuple(solved), time.perf_counter() - start)


def _scaled(progress, done, share):
    if progress is None:
        return None
    return lambda fraction, stage: progress(done + share * fraction, stage)


def _solve_component(holomorph, part, progress):
    reason = reason_to_skip(part)
    if reason:
        return SolvedComponent(part, None, None, reason)
    structure = holomorph.conformal_structure(part, progress=_scaled(progress, 0.0, UV_START))
    structure.prepare_uv(_scaled(progress, UV_START, 1.0 - UV_START))
    return SolvedComponent(part, structure, structure.balanced_coefficients(), "")
