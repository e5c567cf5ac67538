"""The page's programs for PyVista run. In the suite core they are left out where there is no PyVista."""

import re
from pathlib import Path

import holomorph
import numpy as np
import pyvista
from repository import ROOT


def test_the_page_s_examples_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pretzel = holomorph.conformal_structure(holomorph.Surface.read(ROOT / "examples" / "pretzel.obj"))
    pretzel.surface.write("chain.obj")
    uv = pretzel.uv(pretzel.balanced_coefficients())
    names = {"holomorph": holomorph, "np": np, "surface": pretzel.surface, "uv": uv}
    page = (ROOT / "docs" / "python" / "packages.md").read_text(encoding="utf-8")
    for code in re.findall(r"^```python\n(import pyvista\n.*?)^```$", page, re.MULTILINE | re.DOTALL):
        exec(compile(code, "packages.md", "exec"), dict(names))
    pyvista.OFF_SCREEN = False
    forms = pyvista.read("forms.vtp").cell_data
    assert set(forms.keys()) == {f"form {number + 1}" for number in range(2 * pretzel.surface.genus)}
    assert Path("picture.png").stat().st_size > 10_000
