"""Folders of the shared data beside the repository: tests of them are skipped where they are absent."""

import gzip
import json
import re

import numpy as np
import pytest
from holomorph import Surface
from repository import SHARED


def shared_folder(name):
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip(f"no folder ../shared/{name}")
    return folder


def table_of_real_meshes():
    """Rows of the table in the README of ../shared/meshes: file, #V, face sizes, topology, flags."""
    readme = SHARED / "meshes" / "README.md"
    if not readme.is_file():
        return {}
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in readme.read_text().splitlines()]
    return {row[0]: row[1:5] for row in cells if len(row) == 8 and re.fullmatch(r"\d+", row[1])}


REAL = table_of_real_meshes()


def real_file(name, folder):
    """The file itself, or an unpacked copy of it."""
    path = shared_folder("meshes") / name
    if path.suffix != ".gz":
        return path
    unpacked = folder / path.stem
    unpacked.write_bytes(gzip.decompress(path.read_bytes()))
    return unpacked


def by_component(text):
    """'0b11 + 1' as {(0, 11): 1, (1, 0): 1}; None where the README leaves some out or a component is one-sided."""
    if "..." in text or "N" in text:
        return None
    parts = [part.strip().split("b") for part in text.split("+")]
    return sorted((int(part[0]), int(part[1]) if len(part) > 1 else 0) for part in parts)


def reference_values():
    return json.loads((shared_folder("reference") / "values.json").read_text())


def reference_surface(name):
    path = shared_folder("reference") / "meshes" / name
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return Surface.from_edge_lengths(arrays["faces"], arrays["edge_lengths"])
    return Surface.read(path)


def complex_matrix(entry):
    if "Re" in entry:
        return np.array(entry["Re"]) + 1j * np.array(entry["Im"])
    factor = {"i/3": 1j / 3, "i/sqrt(3)": 1j / np.sqrt(3)}[entry["times"]]
    return factor * np.array(entry["matrix"])
