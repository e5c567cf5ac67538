"""Every page of the site, opened as a file: nothing is missing, nothing complains, no link leads nowhere."""

import re
from functools import cache
from urllib.parse import unquote, urldefrag

import holomorph
import pytest
from conftest import SITE
from repository import ROOT

PAGES = sorted(str(path.relative_to(SITE)) for path in SITE.rglob("*.html"))
DOCS = ROOT / "docs"
WRITTEN = {path.relative_to(DOCS / "site" if path.parent.name == "site" else DOCS) for path in DOCS.rglob("*.md")}
BROKEN_IMAGES = "[...document.images].filter(i => !i.complete || i.naturalWidth === 0).map(i => i.src)"
LINKS = "[...document.querySelectorAll('a[href]')].map(a => a.href)"


@cache
def anchors(path):
    return set(re.findall(r'\b(?:id|name)="([^"]+)"', path.read_text(encoding="utf-8")))


def is_broken(link):
    """A link within the site to a file that is not there, or a place that is not in it."""
    address, anchor = urldefrag(unquote(link))
    path = SITE / address.removeprefix(SITE.as_uri() + "/")
    return not path.is_file() or (anchor != "" and path.suffix == ".html" and anchor not in anchors(path))


def test_all_pages_are_there():
    assert {str(page.with_suffix(".html")) for page in WRITTEN} | {"changelog.html"} <= set(PAGES)


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_whole(page, name, pictures):
    page.goto((SITE / name).as_uri())
    page.evaluate("document.querySelectorAll('img').forEach(image => { image.loading = 'eager' })")
    page.wait_for_function("[...document.images].every(image => image.complete)")
    page.screenshot(path=pictures / f"{name.replace('/', '-')}.png")
    assert page.evaluate(BROKEN_IMAGES) == []
    inside = [link for link in page.evaluate(LINKS) if link.startswith("file:")]
    assert inside and [link for link in inside if is_broken(link)] == []
    assert page.complaints == []


@pytest.mark.parametrize("width", [390, 800, 1400])
def test_pages_fit_a_window(open_page, width):
    page = open_page(width)
    for name in PAGES:
        page.goto((SITE / name).as_uri(), wait_until="domcontentloaded")
        assert page.evaluate("document.documentElement.scrollWidth") <= width, name


def test_a_broken_link_would_be_found():
    assert is_broken((SITE / "nowhere.html").as_uri()) and is_broken((SITE / "tiling.html").as_uri() + "#nowhere")
    assert not is_broken((SITE / "tiling.html").as_uri() + "#baking")


@pytest.mark.parametrize(("name", "count"), [("method", 4), ("method/boundaries", 40), ("method/tilings", 40)])
def test_formulas_are_drawn(page, name, count):
    page.goto((SITE / f"{name}.html").as_uri())
    page.wait_for_selector("mjx-container svg")
    page.wait_for_function(f"document.querySelectorAll('mjx-container').length >= {count}")
    assert page.complaints == [] and page.locator("[data-mml-node=merror]").count() == 0


def test_search_without_a_network(page):
    page.goto((SITE / "index.html").as_uri())
    page.fill("input[name=q]", "vertex group")
    page.press("input[name=q]", "Enter")
    page.wait_for_selector("ul.search li a[href^='tutorial.html']")
    assert page.complaints == []


def test_the_palette_can_be_dark(page):
    page.goto((SITE / "index.html").as_uri())
    background = "getComputedStyle(document.body).backgroundColor"
    found = set()
    for theme in ("light", "dark"):
        page.evaluate(f"document.body.dataset.theme = '{theme}'")
        found.add(page.evaluate(background))
    assert len(found) == 2


def test_the_reference_has_every_public_name():
    text = (SITE / "reference.html").read_text(encoding="utf-8")
    modules = {"arrangement", "choice", "distortion", "layout", "report", "__version__"}
    missing = {name for name in set(dir(holomorph)) - modules if f'id="holomorph.{name}"' not in text}
    assert not missing and 'id="module-holomorph.maps.report"' in text
