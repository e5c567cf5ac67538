"""Files are written whole or not at all: a full disk, a limit and the end of the process leave what was there."""

import os
import resource
import signal
import stat
import subprocess
import sys
import time

import families
import pytest
from holomorph import ProgressiveMesh, whole_file
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


@pytest.fixture
def small_files():
    """No file may be longer than 1,000 bytes, as on a full disk."""
    before, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, handler)


def writers():
    surface = surface_of(families.torus(20, 15))
    yield "bytes", lambda path: whole_file.write(path, NEW)
    yield "mesh", surface.write
    yield "progressive mesh", ProgressiveMesh(surface).save


@pytest.mark.parametrize("name, write", list(writers()))
def test_what_does_not_fit_leaves_the_old_file(name, write, old, small_files):
    with pytest.raises(OSError, match="file.obj"):
        write(old)
    assert old.read_bytes() == OLD and list(old.parent.iterdir()) == [old]


def test_a_folder_that_is_missing_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="none/file.obj"):
        whole_file.write(tmp_path / "none" / "file.obj", NEW)


def test_a_process_that_is_killed_leaves_the_old_file_or_the_new_one(old):
    """At any time: the later ones find it done."""
    new = f"b'n' * {len(NEW)}"
    command = f"from holomorph import whole_file\nprint(flush=True)\nwhole_file.write({str(old)!r}, {new})"
    for delay in (0, 1e-4, 3e-4, 1e-3, 3e-3, 0.1):
        old.write_bytes(OLD)
        with subprocess.Popen([sys.executable, "-c", command], stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            time.sleep(delay)
            process.kill()
        assert old.read_bytes() in (OLD, NEW)


def test_several_files_are_moved_together(old):
    (old.parent / "textures").mkdir()
    with whole_file.folder_beside(old) as folder:
        (folder / old.name).write_bytes(NEW)
        (folder / "textures").mkdir()
        (folder / "textures" / "image.png").write_bytes(NEW)
        assert old.read_bytes() == OLD
    assert old.read_bytes() == (old.parent / "textures" / "image.png").read_bytes() == NEW
    assert sorted(each.name for each in old.parent.iterdir()) == [old.name, "textures"]


def test_no_file_is_moved_after_an_error(old):
    with pytest.raises(RuntimeError), whole_file.folder_beside(old) as folder:
        (folder / old.name).write_bytes(NEW)
        raise RuntimeError
    assert old.read_bytes() == OLD and list(old.parent.iterdir()) == [old]
