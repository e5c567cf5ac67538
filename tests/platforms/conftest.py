"""The extensions of all platforms are made once; what ran where they are made is compared with Wine and qemu."""

import os
import subprocess
import zipfile
from pathlib import Path

import pytest
from repository import ROOT

PLATFORMS = ("windows-x64", "macos-arm64", "macos-x64", "linux-x64", "linux-arm64")
PYTHONS = ("cp311", "cp313", "cp314")
SECONDS = 5400


def run(*command, **environment):
    """Run a program; its output, or a failure that shows it."""
    done = subprocess.run(
        ["timeout", "--kill-after=10", str(SECONDS), *map(str, command)],
        env={**os.environ, **{name: str(value) for name, value in environment.items()}},
        cwd=ROOT,
        text=True,
        errors="replace",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\nexit code {done.returncode}\n{done.stdout}"
    return done.stdout


@pytest.fixture(scope="session")
def output(tmp_path_factory):
    return Path(os.environ.get("HOLOMORPH_TEST_OUTPUT") or tmp_path_factory.mktemp("platforms"))


@pytest.fixture(scope="session")
def repository(output):
    """The folder with the extensions and their index."""
    run(ROOT / "scripts" / "package-extension", "--all-platforms", output / "dist")
    return output / "dist" / "repository"


@pytest.fixture(scope="session")
def packages(repository, output):
    """The Python package of a platform as its wheel has it: packages(platform, tag) is a folder for PYTHONPATH."""

    def unpacked(platform, tag):
        folder = output / f"{platform}-{tag}"
        if not folder.exists():
            with zipfile.ZipFile(wheels(extension(repository, platform), output)[tag]) as wheel:
                wheel.extractall(folder)
        return folder

    return unpacked


def extension(repository, platform):
    (found,) = repository.glob(f"holomorph-*-{platform.replace('-', '_')}.zip")
    return found


def wheels(zip_path, folder):
    """The wheels in an extension by the tag of their Python, taken out into a folder."""
    with zipfile.ZipFile(zip_path) as archive:
        names = [name for name in archive.namelist() if name.endswith(".whl")]
        return {name.split("-")[-3]: Path(archive.extract(name, folder)) for name in names}
