"""What a batch shows: index.html, which needs no other file, and every figure in summary.csv and summary.parquet."""

import base64
import csv
import importlib.util
import io
import json
from itertools import zip_longest
from pathlib import Path
from urllib.parse import quote

from ..commands.console import shown
from ..maps.report import part_count
from ..quality.verdicts import LEVELS, special, told
from .journal import noted

TEMPLATE = Path(__file__).with_name("overview.html")
PLACE = "/*ENTRIES*/"  # in the template
FORMULAS = ("=", "+", "-", "@")  # their beginnings
SHOWN = 3  # descriptions and reasons of an asset's parts
ASSET_COLUMNS = ("name", "status", "message", "seconds", "part")


def write(journal, tasks):
    """The overview of the results of tasks; those that are not done yet are left out. @throws StorageError"""
    assets = [found for found in map(_asset, sorted(tasks, key=lambda task: task.name)) if found]
    rows = [row for asset in assets for row in _rows(asset)]
    columns = list(dict.fromkeys([*ASSET_COLUMNS, *(name for row in rows for name in row)]))  # of parts as they occur
    journal.write("summary.csv", _as_csv(rows, columns))
    if importlib.util.find_spec("pyarrow") is not None:
        journal.write("summary.parquet", _as_parquet(rows, columns))
    entries = json.dumps([_entry(asset, journal) for asset in assets], allow_nan=False).replace("<", "\\u003c")
    journal.write("index.html", TEMPLATE.read_text(encoding="utf-8").replace(PLACE, entries).encode())


def _asset(task):
    """(task, record, report); None where nothing is there."""
    record = noted(task)
    if record is None:
        return None
    report = json.loads((task.folder / "report.json").read_bytes()) if "report.json" in record["files"] else {}
    return task, record, report


def _entry(asset, journal):
    """What the page shows of an asset as a whole."""
    task, record, report = asset
    components, whole, verdict = report.get("components", []), report.get("whole") or {}, report.get("verdict")
    parts = [part for part in components if part["done"]]
    reasons = [part["reason"] for part in components if not part["done"]]
    seen = [*told(report), _brief(reasons)]  # of a texture, and what a bake meets
    return {
        "name": shown(task.name),
        "status": record["status"],
        "message": shown(record["message"] or "; ".join(filter(None, seen))),
        "seconds": record["seconds"],
        "faces": report.get("faces"),
        "parts": part_count(components),
        "done": part_count(parts),
        "genus": [part["genus"] for part in parts],
        "loops": [part["boundary_count"] for part in parts],
        "size": whole.get("size_range"),
        "angle": whole.get("mean_angle"),
        "map": _brief(map(_description, parts)),
        "verdict": verdict["level"] if verdict else "",
        "rank": LEVELS.index(verdict["level"]) if verdict else None,
        "folder": quote(task.folder.relative_to(journal.folder).as_posix()) + "/",
        "picture": _data_address(task.folder / "picture.png") if "picture.png" in record["files"] else "",
    }


def _brief(texts):
    """The first of what is told of several parts; report.json has all."""
    distinct = list(dict.fromkeys(texts))
    more = f"; and {len(distinct) - SHOWN} more" if len(distinct) > SHOWN else ""
    return "; ".join(distinct[:SHOWN]) + more


def _description(part):
    if "tiling" not in part:
        return part["description"]
    tiling = part["tiling"]
    named = special(len(tiling["poles"]), tiling["turns"], len(tiling["cones"]), tiling["lines"])
    return f"seamless tiling, {named}"


def _data_address(picture):
    return "data:image/png;base64," + base64.b64encode(picture.read_bytes()).decode()


def _rows(asset):
    """A row for each part of an asset, one where it has none."""
    _, record, report = asset
    common = {name: shown(record[name]) for name in ("name", "status", "message")} | {"seconds": record["seconds"]}
    components = report.get("components", [])
    rows = [
        common | {"part": number} | _flat(part | {"timings": timings})
        for number, (part, timings) in enumerate(zip_longest(components, record.get("timings", [])[: len(components)]))
    ]
    return rows or [common | {"part": None}]


def _flat(entry, prefix=""):
    """Dictionaries in dictionaries as names with dots; lists as JSON."""
    flat = {}
    for name, value in entry.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{name}.")
        else:
            flat[prefix + name] = json.dumps(value) if isinstance(value, list) else value
    return flat


def _as_csv(rows, columns):
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="")
    writer.writeheader()
    writer.writerows({name: _harmless(value) for name, value in row.items()} for row in rows)
    return text.getvalue().encode()


def _harmless(value):
    """A text that a spreadsheet would take for a formula has a ' before it, as one would type it there."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULAS) else value


def _as_parquet(rows, columns):
    import pyarrow
    import pyarrow.parquet

    table = {name: _one_kind([row.get(name) for row in rows]) for name in columns}
    sink = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(pyarrow.table(table), sink)
    return sink.getvalue().to_pybytes()


def _one_kind(values):
    """A column has one type: whole numbers among others become reals, and anything beside text becomes text."""
    kinds = {type(value) for value in values if value is not None}
    if str in kinds and len(kinds) > 1:
        return [None if value is None else str(value) for value in values]
    return [float(value) if type(value) is int else value for value in values] if float in kinds else values
