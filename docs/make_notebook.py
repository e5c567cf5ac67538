# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs examples/plots.ipynb and keeps its pictures in it, in few colours, so that the file stays small."""

import base64
import io
from pathlib import Path

import nbclient
import nbformat
from PIL import Image

NOTEBOOK = Path(__file__).resolve().parents[1] / "examples" / "plots.ipynb"
COLOURS = 64
IMAGE = "image/png"


def small(picture):
    """A PNG file as base64, likewise."""
    image = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB").quantize(COLOURS, dither=0)
    buffer = io.BytesIO()
    image.save(buffer, "PNG", optimize=True)
    return base64.b64encode(buffer.getvalue()).decode()


def kept(output):
    """A cell's output without what differs from run to run."""
    data = {"text/plain": output.data["text/plain"]}
    data |= {IMAGE: small(output.data[IMAGE])} if IMAGE in output.data else {}
    return nbformat.v4.new_output("display_data", data=data)


def main():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbclient.NotebookClient(notebook, timeout=240, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    for cell in (cell for cell in notebook.cells if cell.cell_type == "code"):
        cell.outputs = [kept(output) for output in cell.outputs if "data" in output]
        cell.execution_count, cell.metadata = None, {}
    nbformat.write(notebook, NOTEBOOK)


main()
