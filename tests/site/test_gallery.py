"""The gallery's models, turned by a hand in a real browser."""

import io

import numpy as np
import pytest
from conftest import SITE
from matplotlib.image import imread

MODELS = ("mug", "critter", "lizard", "hand", "pretzel", "lantern")
LOADED = "document.querySelector('model-viewer[data-model=\"{}\"]').loaded"
IMAGES = "model => model.model.materials.filter(m => m.pbrMetallicRoughness.baseColorTexture.texture).length"
ANGLE = "model => model.getCameraOrbit().theta"
DRAG = 150  # pixels
# Whether the model has turned by more than half a radian.
TURNED = "angle => Math.abs(document.querySelector('[data-model={}]').getCameraOrbit().theta - angle) > 0.5"
CHANGED = 0.05  # part of the pixels that this changes at least


@pytest.fixture(scope="module")
def gallery(open_page):
    """Small: it is drawn without a graphics card."""
    page = open_page(700, 500)
    page.goto((SITE / "gallery.html").as_uri())
    return page


def seen(model, path):
    """(height, width, 3) pixels from 0 to 1."""
    return imread(io.BytesIO(model.screenshot(path=path)))[..., :3]


def drag(page, model):
    """Beside the middle, where the viewer has a target of its own for panning."""
    box = model.bounding_box()
    x, y = box["x"] + box["width"] / 4, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + DRAG, y, steps=6)
    page.mouse.up()


@pytest.mark.parametrize("name", MODELS)
def test_a_model_is_turned(gallery, name, pictures):
    model = gallery.locator(f"model-viewer[data-model={name}]")
    model.evaluate("model => model.scrollIntoView({ block: 'center' })")
    gallery.wait_for_function(LOADED.format(name))
    gallery.wait_for_timeout(1000)
    assert model.evaluate(IMAGES) == 1
    before, angle = seen(model, pictures / f"{name}_before.png"), model.evaluate(ANGLE)
    assert before.std() > 0.05  # something is drawn
    drag(gallery, model)
    gallery.wait_for_function(TURNED.format(name), arg=angle)
    gallery.wait_for_timeout(1000)
    after = seen(model, pictures / f"{name}_after.png")
    assert np.mean(np.abs(after - before).max(axis=2) > 0.1) > CHANGED
    assert gallery.complaints == []
