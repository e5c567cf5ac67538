"""A web server with the extension and its index, and a Blender that subscribes to it."""

import functools
import http.server
import shutil
import threading
import zipfile

import pytest
from conftest import run_extension_program
from packages import extension, run
from repository import ROOT, VERSION

SUBSCRIBE = ROOT / "tests" / "package" / "subscribe.py"
NEXT = VERSION.rpartition(".")[0] + f".{int(VERSION.rpartition('.')[2]) + 1}"


def with_next_version(old, new):
    """A copy of the extension whose manifest says the next version."""
    with zipfile.ZipFile(old) as archive, zipfile.ZipFile(new, "w") as copy:
        for info in archive.infolist():
            data = archive.read(info)
            if info.filename.endswith("blender_manifest.toml"):
                data = data.replace(f'\nversion = "{VERSION}"\n'.encode(), f'\nversion = "{NEXT}"\n'.encode())
            copy.writestr(info, data)


@pytest.fixture
def repositories(dist, bpy_python, tmp_path):
    """Two folders with an index: the extension, and the version after it."""
    old, new = tmp_path / "old", tmp_path / "new"
    old.mkdir()
    new.mkdir()
    shutil.copy(extension(dist), old)
    with_next_version(extension(dist), new / extension(dist).name)
    for folder in (old, new):
        run_extension_program(bpy_python, "server-generate", "--repo-dir", folder)
    return old, new


@pytest.fixture
def address(repositories):
    """The address of the index of the first folder."""
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=repositories[0])
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/index.json"
        server.shutdown()


def test_blender_subscribes_installs_and_updates(repositories, address, bpy_python, tmp_path):
    settings = tmp_path / "settings"
    settings.mkdir()
    output = run(bpy_python, SUBSCRIBE, *repositories, address, BLENDER_USER_RESOURCES=settings)
    assert f'installed: version = "{VERSION}"' in output and f'updated: version = "{NEXT}"' in output, output
