"""What cannot be done is said in one clear sentence, and nothing is written."""

import os
from pathlib import Path

import pytest
from batch_runs import library, run, torus_obj
from holomorph.batch import UsageError, recipe, sources

RECIPES = {
    "[maps]\nmian = 'balanced'": "mian is not a key of [maps]; did you mean main?",
    "[map]\nmain = 'balanced'": "map is not a table; did you mean maps?",
    "[maps]\nmain = 'best'": "maps.main is 'best'; one of automatic, seamless, untiled, balanced is needed",
    "[maps]\nforms = -1": "maps.forms is -1; a whole number of at least 0 is needed",
    "[maps]\nforms = true": "maps.forms is True; a whole number of at least 0 is needed",
    "[maps]\nsolver = 'paper'\nthresholds = [0]": "maps.thresholds is [0]; a list of numbers of faces is needed",
    "[maps]\nthresholds = [1000]": "maps.thresholds need maps.solver",
    "[maps]\nrectangle_corners = [1, 2, 3]": "a list of four vertices is needed",
    "[maps]\npoles = [1]\nrectangle_corners = [1, 2, 3, 4]": "cannot be combined",
    "[maps]\npoles = [1, 2]\nresidues = [1]": "differ in length",
    "[maps]\nmargin = nan": "maps.margin is nan",
    "[tiling]\ntiles = 4\ndensity = 2.0": "tiling.density and tiling.tiles cannot be combined",
    "[tiling]\ndirection = [0, 0, 0]": "a list of three numbers that are not all 0 is needed",
    "[output]\nformats = ['fbx']": "a list of npz, obj, ply, glb, blend is needed",
    "[output]\ntexture = 'checker'": "output.texture needs one of output.formats to be glb",
    "[output]\nformats = ['glb']\ntexture = 'absent.png'": "absent.png",
    "[output]\nformats = ['glb']\ntexture = 'recipe.toml'": "not a PNG or JPEG",
    "maps = 3": "maps is 3; a table [maps] is needed",
    "[maps": "this is not TOML",
}


@pytest.mark.parametrize("text", RECIPES)
def test_wrong_recipes(text, tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as raised:
        recipe.read(path)
    assert RECIPES[text] in str(raised.value) and str(raised.value).startswith(str(path))
    assert "\n" not in str(raised.value)


def test_same_options_are_the_same_recipe(tmp_path):
    one, other = tmp_path / "one.toml", tmp_path / "other.toml"
    one.write_text("[maps]\nmain = 'balanced'\nforms = 2\n")
    other.write_text("# the same\n[maps]\nforms = 2\nmain = 'balanced'\n[levels]\n")
    assert recipe.read(one).canonical == recipe.read(other).canonical != recipe.Recipe().canonical


def test_what_is_on_a_texture_tells_recipes_apart_and_not_its_name(tmp_path):
    """It is named from the recipe's folder on."""
    texts = []
    for name, content in (("one", b"a"), ("other", b"a"), ("third", b"b")):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + content)
        path = tmp_path / name / "recipe.toml"
        path.write_text(f"[output]\nformats = ['glb']\ntexture = '{name}.png'\n")
        texts.append(recipe.read(path).canonical)
    assert texts[0] == texts[1] != texts[2]


@pytest.fixture
def folder(tmp_path):
    return library(tmp_path / "library", 3)


def names(given, out):
    return [source.name for source in sources.find(given, out)]


def test_folders_patterns_and_lists(folder, tmp_path):
    out = tmp_path / "out"
    everything = ["props/torus_0.obj", "props/torus_1.obj", "torus_2.obj"]
    assert names([folder], out) == everything
    assert names([str(folder / "**/*.obj")], out) == everything
    assert names([str(folder / "*/torus_1.*")], out) == ["props/torus_1.obj"]
    (folder / "wanted.txt").write_text("# a list\ntorus_2.obj\n\nprops/*.obj\n")
    assert names([folder / "wanted.txt"], out) == ["torus_0.obj", "torus_1.obj", "torus_2.obj"]
    assert names([folder, folder / "torus_2.obj"], out) == everything, "a file that is named twice is one source"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_lists_as_editors_write_them(encoding, newline, folder, tmp_path):
    torus_obj(folder / "a b.obj")
    torus_obj(folder / "\u00fc.obj")
    (folder / "list.txt").write_bytes(newline.join(["a b.obj", "\u00fc.obj\t", ""]).encode(encoding))
    assert names([folder / "list.txt"], tmp_path / "out") == ["a b.obj", "\u00fc.obj"]


def refusal(given, out):
    with pytest.raises(UsageError) as raised:
        sources.find(given, out)
    return str(raised.value)


def test_refused_sources(folder, tmp_path):
    out = tmp_path / "out"
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.md").write_text("")
    (tmp_path / "none.txt").write_text("# nothing\n")
    os.mkfifo(tmp_path / "pipe.obj")
    assert "there is no such file" in refusal([folder / "nothing.obj"], out)
    assert "there is no mesh file" in refusal([tmp_path / "empty"], out)
    assert "is needed" in refusal([tmp_path / "text.md"], out)
    assert "the list is empty" in refusal([tmp_path / "none.txt"], out)
    assert "not a regular file" in refusal([tmp_path / "pipe.obj"], out)


def test_output_in_a_source(folder):
    assert "lies in the source" in refusal([folder], folder / "props" / "out")
    assert "lies in the source" in refusal([folder], folder)


def test_two_sources_with_one_name(folder, tmp_path):
    torus_obj(tmp_path / "torus_2.obj")
    sentence = refusal([folder, tmp_path / "torus_2.obj"], tmp_path / "out")
    assert sentence.startswith("two sources have the name torus_2.obj: ")


WRONG = {
    "unknown source": ["nowhere.obj"],
    "wrong recipe": ["library", "--recipe", "wrong.toml"],
    "no recipe": ["library", "--recipe", "nowhere.toml"],
    "no Blender": ["scene.blend", "--blender", "no-such-blender"],
    "workers": ["library", "--workers", "0"],
    "memory": ["library", "--memory", "much"],
    "both engines": ["library", "--workers", "1", "--dask", "tcp://127.0.0.1:1"],
}


@pytest.mark.parametrize("case", WRONG)
def test_the_command_writes_nothing(case, folder, tmp_path):
    (tmp_path / "wrong.toml").write_text("[maps]\nmian = 'balanced'\n")
    (tmp_path / "scene.blend").write_bytes(b"")
    result = run(*WRONG[case], "--out", "out", cwd=folder.parent)
    assert result.returncode == 2
    assert result.stdout == "" and "Traceback" not in result.stderr
    assert not Path(tmp_path, "out").exists()
