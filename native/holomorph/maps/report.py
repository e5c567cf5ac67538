"""Reports on surfaces, structures and maps, as plain data, ready for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.plain_data import plain
from ..forms.form_structure import CertifiedStructure
from ..quality.verdicts import Verdict
from .whole import whole

if TYPE_CHECKING:
    from ..mesh.repairs import Refused, Repairs
    from ..mesh.surface import Surface
    from ..quality.quality import Quality
    from .automatic_structure import AnyStructure
    from .map import Map

LISTED = 20  # elements of a repair that a report names


def component_report(
    surface: Surface, structure: AnyStructure, main_map: dict[str, Any] | None = None
) -> dict[str, Any]:
    """What is known about the connected `surface` and its `structure`.

    main_map : `map_report` of the map that is shown first; by default that of the balanced coefficients
    """
    certificate = structure.certificate.as_plain() if isinstance(structure, CertifiedStructure) else None
    if main_map is None:
        coefficients = structure.balanced_coefficients()
        main_map = map_report(coefficients, structure.quality(structure.uv(coefficients)))
    return plain(
        {
            "done": True,
            **_topology(surface),
            "description": structure.description,
            "forms": len(main_map["coefficients"]),
            **structure.invariants(),
            **({"certificate": certificate} if certificate else {}),
            "residuals": vars(structure.residuals) | {"solver": structure.solver.residual},
            "solver": vars(structure.solver),
            "timings": structure.timings,
            "intrinsic_flips": structure.flip_count,
            "seam_edges": len(structure.seams),
            "main_map": main_map,
        }
    )


def part_report(made: Map) -> dict[str, Any]:
    """The `component_report` of the part of a `Map`, with what kind of map it is, and of a tiling, or of the
    tilings of its pieces, poles and certificates; vertices are those of the mesh as given."""
    about = {"kind": made.kind, "why": made.why, "evenness": made.evenness}
    about["worst_places"] = {name: place._asdict() for name, place in made.worst_places.items()}
    main_map = map_report(made.coefficients, made.quality, made.verdict) | about
    entry = component_report(made.surface, made.structure, main_map)
    entry["forms"] = made.structure.form_count
    if made.mixed:
        entry["tilings"] = [_tiling_report(tiling, made.surface.vertex_index) for tiling in made.mixed.tilings]
    return entry | ({"tiling": _tiling_report(made.tiling, made.surface.vertex_index)} if made.tiling else {})


def _tiling_report(made, vertex_index):
    zeros, orders = made.zeros
    return plain(
        {
            "added_distortion": float(made.added_distortion),
            "size_range": float(made.size_range),
            "beltrami_rms": float(made.beltrami_rms),
            "tiles": float(made.tiles),
            "poles": vertex_index[made.poles],
            "residues": made.residues,
            "zeros": vertex_index[zeros],
            "orders": np.asarray(orders),
            "periods": np.asarray(made.periods),
        }
    )


def skipped_report(surface: Surface, reason: object) -> dict[str, Any]:
    """Why the connected `surface` was not done."""
    return {"done": False, **_topology(surface), "reason": str(reason)}


def refused_report(refused: Refused) -> dict[str, Any]:
    """Faces that were left out of a surface, a `Refused`."""
    return {"done": False, "faces": len(refused.faces), "reason": refused.reason}


def map_report(coefficients: ArrayLike, quality: Quality, found: Verdict | None = None) -> dict[str, Any]:
    """A UV map: its coefficients, its `Quality` and the `Verdict` on it, by default that of the quality."""
    return plain(
        {
            "coefficients": coefficients,
            "verdict": vars(found or quality.verdict),
            "mean_angle": quality.mean_angle,
            "size_range": quality.size_range,
            "flipped_part": quality.flipped_part,
            "flipped_triangles": np.count_nonzero(quality.flipped),
            "collapsed_triangles": np.count_nonzero(quality.collapsed),
            "overlapping_part": quality.overlapping_part,
        }
    )


def whole_report(maps: Sequence[Map], parts: Sequence[dict[str, Any]], repairs: Repairs) -> dict[str, Any]:
    """`verdict` and `whole` of a mesh, as `whole.whole` takes what it is made of; both are None without a map."""
    found = whole(maps, parts, repairs)
    if found is None:
        return {"verdict": None, "whole": None}
    figures = {name: value for name, value in vars(found).items() if name != "verdict"}
    return plain({"verdict": vars(found.verdict), "whole": figures})


def parts_report(
    parts: Sequence[tuple[Surface, Map | None, str]], refused: Sequence[Refused], repairs: Repairs
) -> dict[str, Any]:
    """What is known of a mesh: `components`, the reports of its parts and of what was left out, its `repairs`, and the
    `whole_report`.

    parts : surface, map or None, and why there is none
    """
    done = [part_report(made) if made else skipped_report(surface, reason) for surface, made, reason in parts]
    entries = done + [refused_report(one) for one in refused]
    whole = whole_report([made for _, made, _ in parts if made], entries, repairs)
    return {**whole, "repairs": repairs_report(repairs), "components": entries}


def repairs_report(repairs: Repairs) -> dict[str, Any]:
    """`Repairs`, with the number and the first of the elements of each kind."""
    arrays = {name: value for name, value in vars(repairs).items() if isinstance(value, np.ndarray)}
    return plain(
        {name: _listed(value) for name, value in arrays.items()}
        | {"cuts": [_cut_report(cut) for cut in repairs.cuts], "mollification": repairs.mollification}
        | {"notes": repairs.notes}
    )


def _listed(elements):
    return {"count": len(elements), "first": elements[:LISTED]}


def _cut_report(cut):
    elements = next(of for of in (cut.vertices, cut.edges, cut.faces) if len(of))
    return {"reason": cut.reason, "text": cut.sentence, **_listed(elements)}


def _topology(surface):
    return {
        "faces": len(surface.face_index),
        "vertices": len(surface.vertex_index),
        "genus": surface.genus,
        "boundary_count": surface.boundary_count,
    }
