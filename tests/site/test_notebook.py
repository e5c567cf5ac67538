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


@pytest.mark.parametrize("call", ["plot.checker", "plot.density", "plot.forms", "plot.zeros", "plot.loops"])
def test_a_plot_is_shown_and_kept(cells, call):
    """Kept by docs/make_notebook.py: of the same size, and what differs from run to run is not."""
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    shown, kept = [], []
    for source, found in ((cells, shown), (notebook.cells, kept)):
        (cell,) = (cell for cell in source if call in cell.source)
        found += images(cell)
    assert len(shown) == len(kept) == 1 and shown[0].shape[:2] == kept[0].shape[:2]
    assert min(kept[0].shape[:2]) > 200 and all(image[..., :3].std() > 0.02 for image in shown + kept)
    assert cell.execution_count is None and "stream" not in [output.output_type for output in cell.outputs]
