"""The notebook of the examples, run from its first cell to its last."""

import base64
import io

import nbclient
import nbformat
import pytest
from matplotlib.image import imread
from repository import ROOT

NOTEBOOK = ROOT / "examples" / "plots.ipynb"


@pytest.fixture(scope="module")
def cells(pictures):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    nbformat.write(notebook, pictures / NOTEBOOK.name)
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def images(cell):
    """(height, width, channels) of each picture that a cell shows."""
    found = [output["data"]["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
    return [imread(io.BytesIO(base64.b64decode(image))) for image in found]


@pytest.mark.parametrize("call", ["plot.checker", "plot.density", "plot.forms", "plot.zeros", "plot.loops", ".show("])
def test_a_plot_is_shown(cells, call):
    (cell,) = (cell for cell in cells if call in cell.source)
    (image,) = images(cell)
    assert min(image.shape[:2]) > 200 and image[..., :3].std() > 0.02


def test_it_is_kept_without_results():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    assert all(not cell.outputs and cell.execution_count is None for cell in notebook.cells if cell.cell_type == "code")
