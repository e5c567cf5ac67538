# SPDX-License-Identifier: GPL-3.0-or-later
"""What is reported of a tiling: first in words, then in numbers."""

from dataclasses import asdict

import numpy as np

from .. import native
from ..maps import tiling
from . import report

SHOWN_PARTS = 8  # of which the redo panel shows a line


def part_report(part):
    """The package's report of a `tiling.TiledPart`, and its tiling; vertices are those of the object."""
    package, component = native.load().report, part.component
    if part.tiling is None:
        return package.skipped_report(component.surface, part.reason)
    made = part.tiling
    main_map = package.map_report([], made.quality, made.verdict)
    entry = package.component_report(component.surface, component.structure, main_map)
    zeros, orders = made.zeros
    return (
        entry
        | report.not_followed(component)
        | {
            "forms": component.form_count,
            "tiling": package.plain(
                {
                    "added_distortion": float(made.added_distortion),
                    "density_ratio": float(made.density_ratio),
                    "left_over": float(made.left_over),
                    "poles": part.vertices(made.poles),
                    "residues": made.residues,
                    "zeros": part.vertices(zeros),
                    "orders": np.asarray(orders),
                    "periods": np.asarray(made.periods),
                }
            ),
        }
    )


def asked(options):
    """`tiling.TileOptions` for a report; where poles are allowed is a vertex group of the object."""
    return {name: value for name, value in asdict(options).items() if name != "allowed"}


def asked_again(stored, allowed):
    """The `tiling.TileOptions` out of a stored report; None where there are none."""
    values = report.parsed(stored).get("asked")
    if values is None:
        return None
    values = {name: _as_tuple(value) for name, value in values.items()}
    return tiling.TileOptions(**values, allowed=allowed)


def _as_tuple(value):
    return tuple(map(_as_tuple, value)) if isinstance(value, list) else value


def read_out(stored):
    """Those of all parts in a stored report, for the redo panel; none if someone has edited it."""
    parts = [part for part in report.parsed(stored).get("components", []) if "tiling" in part]
    if len(parts) == 1:
        return [report.sentence(parts[0]), *report.tiling_lines(parts[0]["tiling"])]
    return [f"Part {index}: {report.sentence(part)}" for index, part in enumerate(parts[:SHOWN_PARTS], 1)]


def draw_read_out(layout, obj):
    """In a redo panel, for the active object or None."""
    lines = read_out(obj.get(report.PROPERTY)) if obj is not None else []
    if lines:
        column = layout.box().column(align=True)
        for line in lines:
            column.label(text=line)


def marks(stored):
    """((n,) vertices, (n,) whether it is a pole) of a stored report; none of one without a tiling."""
    parts = [part["tiling"] for part in report.parsed(stored).get("components", []) if "tiling" in part]
    poles = [vertex for part in parts for vertex in part["poles"]]
    zeros = [vertex for part in parts for vertex in part["zeros"]]
    is_pole = np.arange(len(poles) + len(zeros)) < len(poles)
    return np.array(poles + zeros, np.int64), is_pole
