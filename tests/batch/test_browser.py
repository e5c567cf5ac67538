"""The overview in a real browser: what it shows, its order, its filters."""

import html
import json
import re
import shutil
import subprocess
from urllib.parse import unquote

import pytest
from any_names import any_names
from batch_runs import BALANCED, SECONDS, library, run
from holomorph.commands.console import shown

BROWSERS = ("chromium-headless-shell", "chromium", "google-chrome")
BROWSER = next((found for found in map(shutil.which, BROWSERS) if found), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no Chromium")
# Clicks and types as a user does, and leaves in the page what is seen then.
STEPS = """
<script>
addEventListener("load", () => {
  const names = () => [...document.querySelectorAll("#rows td.name")].map(cell => cell.textContent);
  const head = key => document.querySelector(`th[data-key=${key}] button`);
  const type = text => {
    const filter = document.getElementById("filter");
    filter.value = text;
    filter.dispatchEvent(new Event("input"));
  };
  const seen = { start: names(), summary: document.getElementById("summary").textContent };
  head("faces").click();
  seen.largest = names();
  head("faces").click();
  seen.smallest = names();
  seen.sorted = document.querySelector("th[data-key=faces]").getAttribute("aria-sort");
  type("faces>150 torus");
  seen.filtered = names();
  type("zero area");
  seen.words = names();
  type("");
  document.querySelector("input[name=refused]").click();
  seen.done = names();
  seen.pictures = [...document.images].filter(image => image.complete && image.naturalWidth > 100).length;
  document.title = JSON.stringify(seen);
});
</script>
"""

# What the page shows of names, and whether any of them ran.
ALL_SHOWN = """
<script>
const alerts = [];
window.alert = text => alerts.push(text);
addEventListener("load", () => {
  const cells = [...document.querySelectorAll("#rows td.name")];
  document.title = JSON.stringify({
    names: cells.map(cell => cell.textContent),
    elements: cells.flatMap(cell => [...cell.querySelectorAll("*")]).map(found => found.tagName),
    links: cells.map(cell => cell.querySelector("a").getAttribute("href")),
    scripts: document.scripts.length,
    alerts: alerts.concat(document.title === "attacked" ? ["title"] : []),
  });
});
</script>
"""


def browse(page, *options):
    command = [
        BROWSER,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--virtual-time-budget=5000",
        *options,
        page.as_uri(),
    ]
    return subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True).stdout


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    source = library(folder / "source", 4)
    # A name that would end the script, if it were not escaped, and a message of the library.
    (source / "<script>&amp.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    (folder / "recipe.toml").write_text(BALANCED)
    assert run(source, "--out", folder / "out", "--recipe", folder / "recipe.toml").returncode == 1
    return folder / "out" / "index.html"


def test_it_needs_no_other_file(page):
    text = page.read_text(encoding="utf-8")
    assert not re.findall(r"""(?:src|href)=["'](?!data:)|@import|url\(|https?://""", text)


def test_order_and_filters(page):
    acted = page.with_name("acted.html")
    acted.write_text(page.read_text(encoding="utf-8").replace("</html>", STEPS + "</html>"), encoding="utf-8")
    title = re.search(r"<title>(.*?)</title>", browse(acted, "--dump-dom"), re.DOTALL)[1]
    seen = json.loads(title.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))
    tori = [f"torus_{number}.obj" for number in range(4)]
    small, large = ["props/torus_0.obj", "props/torus_1.obj"], tori[2:]
    assert seen["start"] == ["<script>&amp.obj", *small, *large]
    assert seen["summary"] == "5 assets: 1 refused, 4 done"
    assert seen["largest"] == [*reversed(large), *reversed(small), "<script>&amp.obj"]
    assert seen["smallest"] == [*small, *large, "<script>&amp.obj"] and seen["sorted"] == "ascending"
    assert seen["filtered"] == large
    assert seen["words"] == ["<script>&amp.obj"]
    assert seen["done"] == [*small, *large] and seen["pictures"] == 4


def test_it_is_drawn(page, tmp_path):
    """The checker's orange is there, in each of the four pictures."""
    np = pytest.importorskip("numpy")
    shot = tmp_path / "shot.png"
    browse(page, f"--screenshot={shot}", "--window-size=1300,900", "--hide-scrollbars")
    pixels = subprocess.run(["convert", str(shot), "rgb:-"], capture_output=True, check=True).stdout
    colours = np.frombuffer(pixels, np.uint8).reshape(900, 1300, 3).astype(int)
    orange = (colours[:, :, 0] > 120) & (colours[:, :, 0] > 1.6 * colours[:, :, 1]) & (colours[:, :, 2] < 90)
    rows = np.flatnonzero(orange[:, :140].any(axis=1))
    assert 1 + np.count_nonzero(np.diff(rows) > 20) == 4


def test_no_name_is_more_than_text(tmp_path):
    """Every name is shown, none becomes an element or runs; the links lead to the folders of the results."""
    expected = any_names(tmp_path / "source")
    (tmp_path / "recipe.toml").write_text(BALANCED)
    run(tmp_path / "source", "--out", tmp_path / "out", "--recipe", tmp_path / "recipe.toml")
    page = tmp_path / "out" / "index.html"
    acted = page.with_name("acted.html")
    acted.write_text(page.read_text(encoding="utf-8").replace("</html>", ALL_SHOWN + "</html>"), encoding="utf-8")
    title = re.search(r"<title>(.*?)</title>", browse(acted, "--dump-dom"), re.DOTALL)[1]
    seen = json.loads(html.unescape(title))
    assert sorted(seen["names"]) == sorted(map(shown, expected))
    assert seen["elements"] == ["A"] * len(expected) and seen["scripts"] == 3 and not seen["alerts"]
    assert all((page.parent / unquote(link) / "record.json").is_file() for link in seen["links"])
