"""The extension in the window of a Blender of today: installed from disk as an artist does, and uninstalled."""

import shutil

import pytest
from conftest import MODULE, take

PICTURES = ["install_extensions.png", "install_menu.png", "install_file.png", "install_addons.png"]


def test_it_is_installed_from_disk_and_enabled(installed):
    _, seen = installed
    assert not seen["before"] and seen["after"] and seen["has operator"]


def test_nothing_of_it_is_left_when_it_is_uninstalled(installed, folder, tmp_path):
    own, _ = installed
    place = tmp_path / "own"
    shutil.copytree(own, place, symlinks=True)
    assert list(place.rglob("_native*.so"))
    seen = take("uninstall_steps", folder, "--addons", MODULE, BLENDER_USER_RESOURCES=str(place))
    assert seen["before"] and not seen["after"]
    assert [*place.rglob("*holomorph*")] == [place / "scripts" / "presets" / "holomorph"], "presets are the user's"


@pytest.mark.parametrize("name", PICTURES)
def test_picture_was_taken(installed, folder, name):
    assert (folder / name).stat().st_size > 10_000
