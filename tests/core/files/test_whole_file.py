"""Files are written whole or not at all: a full disk, a limit and the end of the process leave what was there."""

import os
import stat
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import families
import pytest
from holomorph.files import whole_file
from solved import surface_of

OLD, NEW = b"old", b"n" * 100_000


@pytest.fixture
def old(tmp_path):
    path = tmp_path / "file.obj"
    path.write_bytes(OLD)
    return path


def test_a_file_is_replaced(old):
    old.chmod(0o640)
    whole_file.write(old, NEW)
    assert old.read_bytes() == NEW and stat.S_IMODE(old.stat().st_mode) == 0o640
    assert list(old.parent.iterdir()) == [old]


def test_a_link_stays_one(old, tmp_path):
    link = tmp_path / "link.obj"
    link.symlink_to(old)
    whole_file.write(link, NEW)
    assert link.is_symlink() and old.read_bytes() == NEW


def test_a_pipe_is_written_to(tmp_path):
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    with subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE) as reader:
        whole_file.write(pipe, NEW)
        assert reader.communicate()[0] == NEW
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_long_name(tmp_path):
    path = tmp_path / ("n" * 251 + ".obj")
    whole_file.write(path, NEW)
    assert path.read_bytes() == NEW


WRITERS = {
    "bytes": "whole_file.write(path, b'n' * 100_000)",
    "mesh": "Surface.read(mesh).write(path)",
    "progressive mesh": "ProgressiveMesh(Surface.read(mesh)).save(path)",
    "another program": "with whole_file.file_beside(path) as new: write_half(new)",
    "another program's folder": "with whole_file.folder_beside(path) as new: write_half(new / Path(path).name)",
}
# No file may be longer than 1,000 bytes, as on a full disk. In a process of its own: the limit holds for output, too.
LIMITED = """
import contextlib, resource, signal, sys
from pathlib import Path
from holomorph import ProgressiveMesh, Surface
from holomorph.files import whole_file
path, mesh = sys.argv[1:]
def write_half(place):  # and tells nobody
    with contextlib.suppress(OSError), open(place, "wb", buffering=0) as file:
        file.write(b"n" * 5000)
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
try:
    {statement}
except OSError as error:
    print(error)
"""


@pytest.mark.parametrize("name", WRITERS)
def test_what_does_not_fit_leaves_the_old_file(name, old, tmp_path_factory):
    mesh = tmp_path_factory.mktemp("mesh") / "torus.obj"
    surface_of(families.torus(20, 15)).write(mesh)
    command = [sys.executable, "-c", LIMITED.format(statement=WRITERS[name]), old, mesh]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and "file.obj" in done.stdout, done.stderr
    assert old.read_bytes() == OLD and list(old.parent.iterdir()) == [old]


def test_a_folder_that_is_missing_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="none/file.obj"):
        whole_file.write(tmp_path / "none" / "file.obj", NEW)


def test_several_files_are_moved_together(old):
    (old.parent / "textures").mkdir()
    with whole_file.folder_beside(old) as folder:
        (folder / old.name).write_bytes(NEW)
        (folder / "textures").mkdir()
        (folder / "textures" / "image.png").write_bytes(NEW)
        assert old.read_bytes() == OLD
    assert old.read_bytes() == (old.parent / "textures" / "image.png").read_bytes() == NEW
    assert sorted(each.name for each in old.parent.iterdir()) == [old.name, "textures"]


def test_a_file_of_another_program_is_moved_as_it_is(old):
    with whole_file.file_beside(old) as new:
        assert new.parent == old.parent and new.suffix == old.suffix
        new.write_bytes(NEW)
    assert old.read_bytes() == NEW and list(old.parent.iterdir()) == [old]


def test_no_file_is_moved_after_an_error(old):
    with pytest.raises(RuntimeError), whole_file.folder_beside(old) as folder:
        (folder / old.name).write_bytes(NEW)
        raise RuntimeError
    assert old.read_bytes() == OLD and list(old.parent.iterdir()) == [old]


@pytest.mark.parametrize(
    "output, others, overwrite, problem",
    [
        ("new.obj", ["report.json", None], False, None),
        (None, [None], False, None),
        ("./in.obj", [], True, None),
        ("./in.obj", [], False, "in.obj is the input file: use --overwrite to replace it"),
        ("new.obj", ["in.obj"], True, "in.obj is used twice in this run"),
        ("new.obj", ["folder/../new.obj"], True, "new.obj is used twice in this run"),
        ("folder/new.obj", [], False, "the folder .*folder does not exist"),
        ("new.obj", ["."], False, ". is a folder"),
    ],
)
def test_no_file_of_a_run_is_written_over(output, others, overwrite, problem, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    with nullcontext() if problem is None else pytest.raises(ValueError, match=problem):
        whole_file.check_places(["in.obj"], output, others, overwrite)


def test_a_place_where_nothing_may_be_written_is_told_before_any_work(monkeypatch, tmp_path):
    """A file that is there may be replaced in a folder that may be written to, a pipe may be written to in any."""
    monkeypatch.chdir(tmp_path)
    Path("locked").mkdir()
    Path("old.obj").touch()
    os.mkfifo("locked/pipe")
    closed = {Path("locked").resolve(), Path("old.obj").resolve()}
    monkeypatch.setattr(os, "access", lambda path, _mode: Path(path) not in closed)
    with pytest.raises(ValueError, match="locked/new.obj: nothing may be written to .*locked"):
        whole_file.check_places(["in.obj"], "locked/new.obj", [], False)
    whole_file.check_places(["in.obj"], "old.obj", ["locked/pipe"], False)


def test_the_command_keeps_its_mesh(tmp_path):
    path = tmp_path / "torus.obj"
    surface_of(families.torus(8, 6)).write(path)
    before, command = path.read_bytes(), [sys.executable, "-m", "holomorph", path, "--output", path]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and "--overwrite to replace it" in done.stderr and path.read_bytes() == before
    assert subprocess.run([*command, "--overwrite"]).returncode == 0 and b"\nvt " in path.read_bytes()
