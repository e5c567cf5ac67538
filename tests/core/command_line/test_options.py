"""What the command says of itself and of its result, and its dials."""

import json
import os
import subprocess
import sys

import families
import pytest
from holomorph import InvalidMesh, Surface
from holomorph.__main__ import main
from holomorph.commands.console import Parser
from holomorph.files import formats
from solved import surface_of

COMMANDS = ([], ["batch"], ["compare"], ["relief"])


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "torus.glb"
    surface_of(families.torus(20, 10)).write(path)
    return path


def report_of(capsys, *arguments):
    assert main([str(argument) for argument in arguments]) == 0
    return json.loads(capsys.readouterr().out)


def test_one_line_tells_the_verdict(mesh, tmp_path, capsys):
    out, report = tmp_path / "out.obj", tmp_path / "report.json"
    assert main([str(mesh), "--output", str(out), "--report", str(report)]) == 0
    sentence = json.loads(report.read_text())["verdict"]["sentence"]
    assert capsys.readouterr().out == f"{mesh}: {sentence}\n"
    assert main([str(mesh), "--output", str(out), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_a_report_to_standard_output_stands_there_alone(mesh, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = report_of(capsys, mesh, "--output", "out.obj", "--report", "-")
    assert told["verdict"] and sorted(path.name for path in tmp_path.iterdir()) == ["out.obj"]
    assert told["whole"] == report_of(capsys, mesh, "--main", "automatic")["whole"]


def test_dials_are_those_of_the_map(mesh, capsys):
    """They ask for a tiling where nothing else does."""
    (few,) = report_of(capsys, mesh, "--tiles", 12)["components"]
    (many,) = report_of(capsys, mesh, "--tiles", 48)["components"]
    assert few["tiling"]["tiles"] < 20 < 40 < many["tiling"]["tiles"]
    (plain,) = report_of(capsys, mesh, "--evenness", 0)["components"]
    (even,) = report_of(capsys, mesh, "--evenness", 1)["components"]
    assert plain["main_map"]["evenness"] == 0 and even["main_map"]["evenness"] == 1
    assert even["main_map"]["size_range"] < plain["main_map"]["size_range"] - 0.1


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_each_command_has_a_number_a_name_and_an_exit_status_for_mistakes(command, capsys):
    for arguments, status in ((["--version"], 0), ([], 2), (["--none"], 2), (["a", "--threads", "none"], 2)):
        with pytest.raises(SystemExit) as ended:
            main([*command, *arguments])
        assert ended.value.code == status
        told = capsys.readouterr()
        assert (
            told.out.count(".") == 2
            if not status
            else told.err.startswith("usage: " + " ".join(["holomorph", *command]))
        )


@pytest.mark.parametrize(
    ("option", "told"),
    [
        (["--evenness", "2"], "argument --evenness: 2 is given; a number from 0 to 1 is needed"),
        (["--tiles", "-3"], "argument --tiles: -3 is given; a number of tiles or 0 is needed"),
        (["--tiles", "nan"], "argument --tiles: nan is given"),
        (["--tiles", "few"], "argument --tiles: invalid number value: 'few'"),
    ],
)
def test_dials_that_cannot_be_are_refused(option, told, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["absent.obj", *option])
    assert ended.value.code == 2 and told in capsys.readouterr().err


@pytest.mark.parametrize(("option", "told"), [(["--threads", "0"], "threads"), (["--solver", "guess"], "'guess'")])
def test_options_that_cannot_be_end_with_2(option, told, mesh, capsys):
    assert main([str(mesh), *option]) == 2
    assert told in capsys.readouterr().err


# What follows the name of a mesh file, of each command.
AFTER_THE_MESH = {"": [], "compare": ["tri.obj"], "relief": ["dots.png", "--depth=1mm", "--output=part.stl"]}
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.obj").mkdir()
    for name, text in {"tri.obj": TRIANGLE, "empty.obj": "v 0 0 0\n", "mesh.xyz": "0 0 0\n", "dots.png": ""}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def ended(capsys, *arguments):
    """The status and the one sentence of a command that writes nothing."""
    before = sorted(os.listdir())
    status = main(list(arguments))
    told = capsys.readouterr()
    assert not told.out and told.err.count("\n") == 1 and sorted(os.listdir()) == before
    return status, told.err


@pytest.mark.parametrize("command", AFTER_THE_MESH)
@pytest.mark.parametrize("name", ["absent.obj", "absent.xyz", "mesh.xyz", "folder.obj"])
def test_what_is_no_mesh_file_ends_with_2(command, name, folder, capsys):
    status, told = ended(capsys, *command.split(), name, *AFTER_THE_MESH[command])
    assert status == 2 and name in told


@pytest.mark.parametrize("command", ["", "compare"])
def test_a_file_without_faces_ends_with_1(command, folder, capsys):
    assert ended(capsys, *command.split(), "empty.obj", *AFTER_THE_MESH[command]) == (
        1,
        "holomorph: empty.obj: the mesh has no faces\n",
    )


PLACES = {
    "tri.obj --report folder.obj": "folder.obj is a folder",
    "tri.obj --report absent/report.json": "absent does not exist",
    "tri.obj --report tri.obj": "is used twice",
    "tri.obj --output folder.obj": "folder.obj is a folder",
    "tri.obj --output absent/out.obj": "absent does not exist",
    "tri.obj --output out.txt": "out.txt must end with .obj, .ply or .glb",
    "tri.obj --output out": "out must end with .obj, .ply or .glb",
    "compare tri.obj tri.obj --report tri.obj": "is used twice",
    "relief tri.obj absent.png --depth 1mm --output part.stl": "absent.png",
    "relief tri.obj dots.png --depth 1mm --output absent/part.stl": "absent does not exist",
}


@pytest.mark.parametrize("command", PLACES)
def test_places_that_cannot_be_end_with_2_before_any_work(command, folder, capsys, monkeypatch):
    monkeypatch.setattr(Surface, "read", None)
    status, told = ended(capsys, *command.split())
    assert status == 2 and PLACES[command] in told


def test_the_endings_of_mesh_files_are_those_that_are_read(tmp_path):
    for ending in formats.READERS:
        with pytest.raises(InvalidMesh, match="no such file"):
            Surface.read(tmp_path / f"absent{ending}")


def test_the_program_is_named_as_it_was_started():
    run = subprocess.run([sys.executable, "-m", "holomorph", "compare"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 2 and run.stderr.startswith("usage: python -m holomorph compare ")
    assert Parser("batch").prog == "holomorph batch"
