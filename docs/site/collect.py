# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects what the pages of the site are made of: collect.py WORK

WORK/pages gets the Markdown of docs, its folders too, and of docs/site with the pictures, WORK/static what the browser
runs and shows. A page that is opened as a file may not fetch other files, but may run scripts: so each model is wrapped
in one.
"""

import base64
import shutil
import sys
from pathlib import Path

SITE = Path(__file__).resolve().parent
ROOT = SITE.parents[1]
SCRIPTS = {
    "@google/model-viewer/dist/model-viewer-umd.min.js": "model-viewer.js",
    "@google/model-viewer/LICENSE": "model-viewer.LICENSE.txt",
    "mathjax/es5/tex-svg.js": "mathjax.js",
    "mathjax/LICENSE": "mathjax.LICENSE.txt",
}
SHOWN = """document.querySelector('model-viewer[data-model="{}"]').src = "data:model/gltf-binary;base64,{}";\n"""


def collect_pages(pages):
    for folder in ("pictures", "figures"):
        shutil.copytree(ROOT / "docs" / folder, pages / folder)
    for page in [*(ROOT / "docs").rglob("*.md"), ROOT / "docs" / "bibliography.bib"]:
        place = pages / page.relative_to(SITE if page.parent == SITE else ROOT / "docs")
        place.parent.mkdir(exist_ok=True)
        shutil.copy(page, place)
    shutil.copy(ROOT / "CHANGELOG.md", pages / "changelog.md")


def collect_static(static, work):
    for source, name in SCRIPTS.items():
        shutil.copy(work / "node" / "node_modules" / source, static / name)
    shutil.copy(SITE / "site.css", static)
    for model in (work / "models").glob("*.glb"):
        text = SHOWN.format(model.stem, base64.b64encode(model.read_bytes()).decode())
        (static / f"model-{model.stem}.js").write_text(text, encoding="ascii")


def main():
    work = Path(sys.argv[1])
    for name in ("pages", "static"):
        shutil.rmtree(work / name, ignore_errors=True)
        (work / name).mkdir()
    collect_pages(work / "pages")
    collect_static(work / "static", work)


main()
