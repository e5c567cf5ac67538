"""The zips for Blender, made with wheels that hold nothing: what the extension platform refuses is not in them."""

import importlib.machinery
import importlib.util
import re
import zipfile

import pytest
import tomllib
from repository import ROOT, VERSION

# What reviewers refuse: other ways to find modules than Blender's, threads, other programs, the network, hidden code.
REFUSED = ("sys.modules", "sys.path", "sys.meta_path", "importlib.util", "ensurepip", "ctypes", "eval(", "exec(")
REFUSED += ("threading", "_thread", "concurrent", "multiprocessing", "subprocess", "os.system", "os.popen", "os.exec")
REFUSED += (
    "urllib",
    "http.client",
    "socket.socket",
    "import requests",
    "ftplib",
    "url_open",
    "webbrowser",
    "online_access",
)
# https://docs.blender.org/manual/en/latest/advanced/extensions/tags.html
TAGS = {"3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine"}
TAGS |= {"Geometry Nodes", "Grease Pencil", "Import-Export", "Lighting", "Material", "Mesh", "Modeling", "Node"}
TAGS |= {"Object", "Paint", "Physics", "Pipeline", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System"}
TAGS |= {"Text Editor", "Tracking", "User Interface", "UV"}
MOST_LETTERS = 64  # of a tagline, and of a reason for a permission
ENDS = ("win_amd64", "macosx_11_0_arm64", "macosx_11_0_x86_64", "manylinux_2_28_x86_64", "manylinux_2_28_aarch64")


def words(names):
    """Each as a pattern that does not find it inside a longer word."""
    return {name: re.compile(rf"(?<![\w.]){re.escape(name)}" + r"(?!\w)" * name[-1].isalnum()) for name in names}


def refused(files):
    """(file, word) of each word in the sources that no extension may have."""
    patterns = words(REFUSED)
    return [(path, word) for path, text in files.items() for word, pattern in patterns.items() if pattern.search(text)]


@pytest.fixture(scope="module")
def make_zips():
    path = str(ROOT / "scripts" / "make-zips.py")
    module = importlib.util.module_from_spec(importlib.util.spec_from_file_location("make_zips", path))
    module.__spec__.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def wheels(tmp_path_factory):
    """One for each platform and Python."""
    folder = tmp_path_factory.mktemp("wheels")
    for tag in ("cp311", "cp313", "cp314"):
        for end in ENDS:
            with zipfile.ZipFile(folder / f"holomorph-{VERSION}-{tag}-{tag}-{end}.whl", "w") as wheel:
                wheel.writestr("holomorph/__init__.py", f"TAG = {tag!r}  # {end}\n" * 9)
    return sorted(folder.iterdir())


@pytest.fixture(scope="module")
def zips(make_zips, wheels, tmp_path_factory):
    """{end of the name: {file: bytes}}, each without the folder that it lies in."""
    folder, found = tmp_path_factory.mktemp("zips"), {}
    make_zips.main(folder, *wheels)
    for path in folder.glob("*.zip"):
        with zipfile.ZipFile(path) as archive:
            files = {name.partition("/")[2]: archive.read(name) for name in archive.namelist()}
        found[path.stem.removeprefix(f"holomorph-{VERSION}-")] = files
    return found


def extensions(zips):
    return {name: files for name, files in zips.items() if name != "blender-3.4"}


def sources(files):
    return {name: data.decode() for name, data in files.items() if name.endswith((".py", ".toml"))}


def test_no_extension_has_what_reviewers_refuse(zips):
    assert len(extensions(zips)) == len(ENDS)
    for files in extensions(zips).values():
        assert not refused(sources(files))


@pytest.mark.parametrize("word", REFUSED)
def test_each_refused_word_is_found(word):
    assert refused({"planted.py": f"x = {word}" + "y" * (not word[-1].isalnum())}) == [("planted.py", word)]
    assert refused({"planted.py": f"x = my_{word}"}) == []


def test_its_own_folder_is_only_read(zips):
    """It may not be writable, and an update removes what lies there."""
    using = {name for name, text in sources(zips["linux_x64"]).items() if "__file__" in text}
    assert using == {"headless.py"}  # finds `folders`, where that lies beside it


def test_wheels_are_those_of_the_package_index_byte_for_byte(zips, wheels):
    inside = [item for files in extensions(zips).values() for item in files.items() if item[0].endswith(".whl")]
    assert dict(inside) == {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    assert len(inside) == len(wheels)


def test_the_zip_for_blender_3_4_has_the_same_source_and_one_file_more(zips, make_zips):
    legacy, extension = zips["blender-3.4"], zips["linux_x64"]
    own = {name: data for name, data in legacy.items() if not name.startswith("lib/cp311/holomorph/")}
    same = {name: data for name, data in extension.items() if not name.startswith(("wheels/", "blender_manifest"))}
    assert own.keys() - same.keys() == {make_zips.LEGACY_ONLY} and same.items() <= own.items()


def test_the_manifest_keeps_the_rules(zips):
    for platform, files in extensions(zips).items():
        manifest = tomllib.loads(files["blender_manifest.toml"].decode())
        assert manifest["platforms"] == [platform.replace("_", "-")]
        assert {f"./{name}" for name in files if name.endswith(".whl")} == set(manifest["wheels"])
        for text in (manifest["tagline"], *manifest["permissions"].values()):
            assert 0 < len(text) <= MOST_LETTERS and text[-1].isalnum()
        assert set(manifest["permissions"]) == {"files"}
        assert set(manifest["tags"]) <= TAGS
        assert all(re.fullmatch(r"\d{4}(-\d{4})? \S.*", each) for each in manifest["copyright"])


@pytest.mark.parametrize("address", [None, "https://example.org/holomorph"])
def test_the_website_is_the_home_page(make_zips, wheels, address):
    source = (ROOT / "addon" / "blender_manifest.toml").read_text(encoding="utf-8")
    manifest = tomllib.loads(make_zips.completed(source, "linux-x64", wheels[:1], address))
    assert manifest.get("website") == address and manifest["permissions"]
