"""The site as scripts/site has built it, in a real browser."""

import os
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright
from repository import ROOT

SITE = ROOT / "build" / "site"
BROWSERS = ("chromium-headless-shell", "chromium", "google-chrome")
# WebGL without a graphics card.
OPTIONS = ["--no-sandbox", "--enable-unsafe-swiftshader"]
OWN = ("file:", "data:", "blob:")  # addresses that need no network
PATIENCE = 300_000  # milliseconds, on a machine that has other things to do


@pytest.fixture(scope="session")
def browser():
    program = next((found for found in map(shutil.which, BROWSERS) if found), None)
    if program is None:
        pytest.skip("no Chromium")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=program, args=OPTIONS)
        yield started
        started.close()


@pytest.fixture(scope="module")
def open_page(browser):
    """open_page(width, height): a page that notes in `complaints` what goes wrong in it: errors, and requests that
    leave the site."""
    opened = []

    def start(width=1400, height=900):
        page = browser.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(PATIENCE)
        page.complaints = complaints = []
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda request: None if request.url.startswith(OWN) else complaints.append(request.url))
        opened.append(page)
        return page

    yield start
    for page in opened:
        page.close()


@pytest.fixture
def page(open_page):
    return open_page()


@pytest.fixture(scope="session")
def pictures(tmp_path_factory):
    """Where screenshots are left: to be looked at after scripts/test."""
    wanted = os.environ.get("HOLOMORPH_TEST_OUTPUT")
    return Path(wanted) if wanted else tmp_path_factory.mktemp("pictures")
