"""What a batch takes from folders that others write to: nothing in them is imported, emptied or believed."""

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from batch_runs import BALANCED, SECONDS, run, statuses, torus_obj
from holomorph.batch.journal import stored

MARK = "import os, pathlib\npathlib.Path(os.environ['HOLOMORPH_TEST_MARK'], {name!r}).touch()\nraise SystemExit(9)\n"
ROGUES = (
    "holomorph",
    "numpy",
    "tqdm",
    "json",
    "ctypes",
    "hashlib",
    "threading",
    "zlib",
    "sitecustomize",
    "distributed",
)
SCRIPT = """import os, sys
os.environ["PYTHONPATH"] = {path!r}
from holomorph.__main__ import command
sys.exit(command())
"""  # as pip makes it, but for the path


@pytest.fixture
def trap(tmp_path):
    """A folder with a mesh, and modules that leave a mark where they are imported."""
    folder, marks = tmp_path / "assets", tmp_path / "marks"
    folder.mkdir()
    marks.mkdir()
    torus_obj(folder / "torus.obj")
    for name in ROGUES:
        (folder / f"{name}.py").write_text(MARK.format(name=name))
    (folder / "recipe.toml").write_text(BALANCED)
    return folder, marks


def run_in(folder, marks, words, tmp_path, *more, **variables):
    """The finished batch of torus.obj, with the folder as the current one."""
    command = [sys.executable, *words, "torus.obj", "--out", tmp_path / "out", "--recipe", "recipe.toml", *more]
    environment = os.environ | {"HOLOMORPH_TEST_MARK": str(marks)} | variables
    return subprocess.run(
        list(map(str, command)), cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS
    )


def assert_nothing_imported(done, out, marks):
    assert done.returncode == 0, done.stderr
    assert not [path.name for path in marks.iterdir()]
    assert statuses(out) == {"torus.obj": "done"}


@pytest.mark.parametrize("more", [[], [""]], ids=["plain", "an empty entry"])
def test_a_script_and_its_workers_import_nothing_from_the_current_folder(more, trap, tmp_path):
    """Not even workers where PYTHONPATH has an empty entry, which stands for it."""
    folder, marks = trap
    own = [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    program = tmp_path / "bin" / "holomorph"
    program.parent.mkdir()
    program.write_text(SCRIPT.format(path=os.pathsep.join(own + more)))
    done = run_in(folder, marks, [program, "batch"], tmp_path, PYTHONPATH=os.pathsep.join(own))
    assert_nothing_imported(done, tmp_path / "out", marks)


def test_the_module_imports_nothing_more_from_the_current_folder(trap, tmp_path):
    """Python itself has looked there for the package."""
    folder, marks = trap
    for name in ("holomorph", "sitecustomize"):
        (folder / f"{name}.py").unlink()
    done = run_in(folder, marks, ["-m", "holomorph", "batch"], tmp_path)
    assert_nothing_imported(done, tmp_path / "out", marks)


def test_blender_imports_nothing_from_the_current_folder(trap, tmp_path):
    blender = os.environ.get("HOLOMORPH_BLENDER", "blender")
    folder, marks = trap
    (folder / "recipe.toml").write_text(BALANCED.replace("'obj'", "'blend'"))
    done = run_in(folder, marks, ["-P", "-m", "holomorph", "batch"], tmp_path, "--blender", blender)
    if "there is no program" in done.stderr:
        pytest.skip("no Blender")
    assert_nothing_imported(done, tmp_path / "out", marks)
    assert (tmp_path / "out" / "assets" / "torus.obj" / "mesh.blend").stat().st_size


WHOLE = {"a list": "[]", "a number": "7", "nothing": "null", "text": '"done"', "not JSON": "{", "nested": "[" * 100_000}
PARTS = {  # of a record, in place of its own
    "files as a list": {"files": ["a"]},
    "a file above the folder": {"files": {"../record.json": 1}},
    "a number as name": {"name": 1},
    "a list as key": {"key": [1]},
    "an unknown status": {"status": "splendid"},
    "no message": {"message": None},
    "an unknown level": {"verdict": "splendid"},
    "seconds as text": {"seconds": "1"},
    "parts as text": {"skipped": "none"},
}


@pytest.fixture
def done_once(tmp_path, recipe):
    torus_obj(tmp_path / "torus.obj")
    arguments = [tmp_path / "torus.obj", "--out", tmp_path / "out", "--recipe", recipe, "--workers", 1]
    assert run(*arguments).returncode == 0
    return arguments, tmp_path / "out" / "assets" / "torus.obj" / "record.json"


def test_a_record_of_another_shape_is_as_none(done_once):
    arguments, path = done_once
    right = json.loads(path.read_text())
    wrong = WHOLE | {name: json.dumps(right | part) for name, part in PARTS.items()}
    wrong["no files"] = json.dumps({name: value for name, value in right.items() if name != "files"})
    task = SimpleNamespace(folder=path.parent, key=right["key"])
    assert stored(task) == right
    for name, text in wrong.items():
        path.write_text(text)
        assert stored(task) is None, name
    done = run(*arguments)
    assert done.returncode == 0 and "1 done" in done.stdout, done.stderr
    assert json.loads(path.read_text()).keys() == right.keys()


def test_a_record_that_is_a_pipe_is_not_waited_for(done_once):
    arguments, path = done_once
    path.unlink()
    os.mkfifo(path)
    assert run(*arguments).returncode == 0
    assert path.is_file()


def test_a_folder_of_work_that_leads_elsewhere_is_refused(tmp_path, recipe):
    """It would be emptied."""
    torus_obj(tmp_path / "torus.obj")
    precious, out = tmp_path / "precious", tmp_path / "out"
    (precious / "all").mkdir(parents=True)
    (precious / "all" / "file").touch()
    out.mkdir()
    for place, target in ((out / ".work", precious), (out / ".lock", precious / "all" / "file")):
        place.symlink_to(target)
        for share in ([], ["--share", "1/1"]):
            done = run(tmp_path / "torus.obj", "--out", out, "--recipe", recipe, *share)
            assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
            assert str(place) in done.stderr and "remove it" in done.stderr
        assert (precious / "all" / "file").exists()
        place.unlink()
    (out / ".work").mkdir()
    (out / ".work" / "all").symlink_to(precious)
    assert "remove it" in run(tmp_path / "torus.obj", "--out", out, "--recipe", recipe).stderr
    assert (precious / "all" / "file").exists()


def test_pipes_are_no_recipe_and_no_texture(tmp_path):
    torus_obj(tmp_path / "torus.obj")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "recipe.toml").write_text('[output]\nformats = ["glb"]\ntexture = "pipe"\n')
    for recipe in ("pipe", "recipe.toml"):
        done = run(tmp_path / "torus.obj", "--out", tmp_path / "out", "--recipe", tmp_path / recipe)
        assert done.returncode == 2 and "a pipe or a device" in done.stderr and len(done.stderr.splitlines()) == 1


def test_what_nothing_foresaw_ends_its_asset_in_one_sentence(tmp_path, recipe):
    """With a report to send beside its record; the others are done."""
    for name in ("torus.obj", "fault_torus.obj"):
        torus_obj(tmp_path / name)
    done = run(
        *(tmp_path / "torus.obj", tmp_path / "fault_torus.obj", "--out", tmp_path / "out", "--recipe", recipe),
        marks=tmp_path,
    )
    assert done.returncode == 1
    assert statuses(tmp_path / "out") == {"fault_torus.obj": "crashed", "torus.obj": "done"}
    (line,) = [line for line in done.stderr.splitlines() if "fault_torus.obj" in line]
    assert "a fault of Holomorph, not of the data: ZeroDivisionError" in line and "fault.txt" in line
    report = (tmp_path / "out" / "assets" / "fault_torus.obj" / "fault.txt").read_text()
    assert "Traceback" in report and Path(__file__).name not in report
