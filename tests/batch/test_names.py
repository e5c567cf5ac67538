"""Any name and any entry: each asset is done or reported, and none garbles a page, a table or a terminal."""

import csv
import io
import json
import os
import unicodedata

import pytest
from any_names import any_entries, any_names
from batch_runs import command, outputs, run, statuses, torus_obj
from holomorph.batch import sources
from holomorph.batch.command import LONGEST, Plan, of_source
from holomorph.batch.journal import Journal
from holomorph.batch.recipe import Recipe
from holomorph.commands.console import shown
from holomorph.files.names import LONGEST_PART, told_apart


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    """({name: status}, folder of the results, the finished process) of a folder with all of them."""
    folder = tmp_path_factory.mktemp("names")
    expected = dict.fromkeys(any_names(folder / "source"), "done") | any_entries(folder / "source")
    (folder / "recipe.toml").write_text("[maps]\nmain = 'balanced'\n")
    return expected, folder / "out", run(folder / "source", "--out", folder / "out", "--recipe", folder / "recipe.toml")


def test_each_is_done_or_reported(everything):
    expected, out, result = everything
    assert statuses(out) == expected
    assert result.returncode == 1, result.stderr


def test_what_is_done_is_found_again(everything):
    _, out, result = everything
    before = outputs(out)
    again = run(*result.args[4:])
    assert again.returncode == 1 and again.stdout == result.stdout
    assert outputs(out) == before


def test_terminal(everything):
    """A line for each that is not done, in any order, without a character that a terminal would act on."""
    expected, _, result = everything
    lines = result.stderr.splitlines()
    assert all(line.isprintable() for line in [*lines, *result.stdout.splitlines()])
    failed = sorted(shown(name) for name, status in expected.items() if status != "done")
    assert sorted(line.partition(": ")[0] for line in lines) == failed


def test_table(everything):
    """One row for each; no name is a formula, and no two are one."""
    expected, out, _ = everything
    content = (out / "summary.csv").read_bytes()
    rows = list(csv.DictReader(io.StringIO(content.decode())))
    assert content.count(b"\n") == len(rows) + 1 == len(expected) + 1
    assert not [row["name"] for row in rows if row["name"][0] in "=+-@"]
    assert {row["name"].removeprefix("'") for row in rows} == {shown(name) for name in expected}
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(out / "summary.parquet").to_pylist()
    assert {row["name"] for row in table} == {shown(name) for name in expected}


def test_page_is_one_script(everything):
    """No name ends the element that holds the entries, or begins another."""
    expected, out, _ = everything
    page = (out / "index.html").read_text(encoding="utf-8")
    start = page.index('id="entries">') + len('id="entries">')
    entries = page[start : page.index("</script>", start)]
    assert "<" not in entries and entries.isascii()
    assert sorted(entry["name"] for entry in json.loads(entries)) == sorted(shown(name) for name in expected)


def test_a_name_of_an_option_as_a_source(tmp_path, recipe):
    """From a shell's *."""
    torus_obj(tmp_path / "--retry.obj", 8, 6)
    result = run("--out", "out", "--recipe", recipe, "--", "--retry.obj", cwd=tmp_path)
    assert result.returncode == 0, result.stderr


def test_an_asset_that_became_a_folder_and_back(tmp_path, recipe):
    """The results of neither are in the other's folder: nothing is lost."""
    source, arguments = tmp_path / "source", (tmp_path / "source", "--out", tmp_path / "out", "--recipe", recipe)
    source.mkdir()
    torus_obj(source / "chair.obj")
    assert run(*arguments).returncode == 0
    (source / "chair.obj").unlink()
    (source / "chair.obj").mkdir()
    torus_obj(source / "chair.obj" / "mesh.obj", 20)
    torus_obj(source / "chair.obj" / "leg.obj", 28)
    assert run(*arguments).returncode == 0
    kept = outputs(tmp_path / "out")
    assert set(statuses(tmp_path / "out")) == {"chair.obj", "chair.obj/mesh.obj", "chair.obj/leg.obj"}
    (source / "chair.obj").rename(tmp_path / "parts")
    torus_obj(source / "chair.obj", 16)
    assert run(*arguments).returncode == 0
    assert set(statuses(tmp_path / "out")) == {"chair.obj", "chair.obj/mesh.obj", "chair.obj/leg.obj"}
    parts = {path: content for path, content in kept.items() if not path.startswith("assets/chair.obj/")}
    assert len(parts) == 2 * len(kept) / 3 and parts.items() < outputs(tmp_path / "out").items()


def test_a_file_and_a_folder_of_one_name_in_two_sources(tmp_path, recipe):
    for place in ("one", "other/chair.obj"):
        (tmp_path / place).mkdir(parents=True)
        torus_obj(tmp_path / place / "chair.obj")
    result = run(tmp_path / "one", tmp_path / "other", "--out", tmp_path / "out", "--recipe", recipe)
    assert result.returncode == 0, result.stderr
    assert statuses(tmp_path / "out") == {"chair.obj": "done", "chair.obj/chair.obj": "done"}


def test_a_folder_that_cannot_be_read(tmp_path, recipe):
    """It is told, and what is known of it stays."""
    source, out = tmp_path / "source", tmp_path / "out"
    (source / "closed").mkdir(parents=True)
    torus_obj(source / "closed" / "torus.obj")
    torus_obj(source / "torus.obj")
    arguments = command(source, "--out", out, "--recipe", recipe)
    assert run(*arguments[4:]).returncode == 0
    (source / "closed").chmod(0)
    if os.access(source / "closed", os.R_OK):
        pytest.skip("root reads every folder")
    assert run(*arguments[4:]).returncode == 1
    assert statuses(out) == {"torus.obj": "done", "closed/torus.obj": "done", "closed/": "refused"}


LENGTHS = (1, 190, 196, 200, 201, 230, 251)


@pytest.mark.parametrize("letter", "aA%é環🍩\udcff .")
def test_paths(letter):
    """Folders of names of any length are short enough, plain, and each its own in any case; a folder's has two more."""
    stems = {(letter * length).encode("utf-8", "surrogateescape")[:251] for length in LENGTHS}
    names = [os.fsdecode(stem) + suffix for stem in sorted(stems) for suffix in (".obj", ".OBJ", "")]
    paths = told_apart([*names, *(f"{name}/x.obj" for name in names)], of_source)
    assert len({path.lower() for path in paths.values()}) == 2 * len(names)
    for path in paths.values():
        assert path.isascii() and len(path) <= LONGEST and not set('<>:"\\|?*') & set(path)
        assert all(0 < len(part) <= LONGEST_PART + 2 and part[-1] not in ". " for part in path.split("/"))
    assert {of_source(path) for path in ("props/chair.obj", "a b.blend")} == {"props/chair.obj", "a b.blend"}


def test_names_that_systems_take_for_one_or_for_none():
    """Letters with accents of two spellings, devices of Windows; every way to name files passes here."""
    spelt = ["\u00e9", "e\u0301", "E\u0301", "ß", "ss"]
    paths = told_apart(spelt, str)
    assert len({unicodedata.normalize("NFC", path).casefold() for path in paths.values()}) == len(spelt)
    for name in ("con", "NUL.obj", "com1", "lpt9.tar.gz"):
        assert of_source(name).startswith(f"%{ord(name[0]):02X}")
    assert {of_source(name) for name in ("cone.obj", "com", "lpt.obj")} == {"cone.obj", "com", "lpt.obj"}


def test_paths_of_deep_folders():
    deep = "環/" * 500
    assert len(of_source(f"{deep}a.obj")) <= LONGEST
    assert of_source(f"{deep}a.obj") != of_source(f"{deep}環/a.obj")


def test_no_path_of_a_name_is_one_within_another():
    """A plain name may look like one that was cut, or like the folder of another asset."""
    long = "n" * 251 + ".obj"
    names = [
        long,
        of_source(long),
        "x.obj",
        "x.obj/y.obj",
        "x%2Eobj/y.obj",
        "x.obj/y.obj/z.obj",
        "x^.obj",
        "sub/",
        "sub/^",
    ]
    paths = told_apart(names, of_source)
    for path in paths.values():
        assert not [other for other in paths.values() if other != path and other.startswith(f"{path}/")]
    assert len(set(paths.values())) == len(names)


def test_objects_of_a_scene(tmp_path):
    """Their names are any text; a folder of sources that is called as the scene does not have their results."""
    path = tmp_path / "town.blend"
    path.touch()
    found = [sources.Source("town.blend", path), sources.Source("town.blend/Roof.obj", torus_obj(tmp_path / "a.obj"))]
    names = ["Roof", "roof", "a/b", "a%2Fb", "a%b", "..", ".", "Roof.obj", "n" * 63, "ж" * 31, "\n"]
    plan = Plan(found, Journal(tmp_path / "out"), Recipe(), 1, "")
    (opening,) = plan.openings
    opening.folder.mkdir(parents=True)
    listed = [[name, f"{number}.npz", 4] for number, name in enumerate(names)]
    (opening.folder / "objects.json").write_text(json.dumps(listed))
    tasks = plan.tasks()
    assert len({str(task.folder).lower() for task in tasks}) == len({task.key for task in tasks}) == len(names) + 1
    assert len({task.name for task in tasks if task.scene}) == len(names)
    assert {len(task.folder.relative_to(tmp_path / "out" / "assets").parts) for task in tasks} == {2}


def test_names_that_become_one_on_the_terminal():
    texts = ["a\\x41", "aA", "\x1b", "\\x1b", "\udcff", "\\xff", "\xff", "\n", "\\n", "\u202e", "می‌خواهم"]
    assert len({shown(text) for text in texts}) == len(texts)
    assert shown("می‌خواهم") == "می‌خواهم"


def test_a_list_names_files_by_their_bytes(tmp_path, recipe):
    folder = os.fsencode(tmp_path)
    mesh = torus_obj(tmp_path / "mesh.obj", 8, 6).read_bytes()
    for name in (b"caf\xe9.obj", "two\u2028lines.obj".encode()):
        try:
            with open(os.path.join(folder, name), "wb") as file:
                file.write(mesh)
        except OSError:
            pytest.skip("this file system takes names of letters alone")
    (tmp_path / "list.txt").write_bytes(b"caf\xe9.obj\r\n" + "two\u2028lines.obj\n".encode())
    result = run(tmp_path / "list.txt", "--out", tmp_path / "out", "--recipe", recipe)
    assert result.returncode == 0, result.stderr
    assert len(statuses(tmp_path / "out")) == 2
