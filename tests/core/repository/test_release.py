"""One number in all files that name the version, and a release that is refused where something is not ready."""

import importlib.machinery
import importlib.util
import re
import shutil
import subprocess

import holomorph
import pytest
from repository import ROOT, VERSION

CHANGELOG = "# Changelog\n\n## [2.0.0] - 2030-01-31\n\n- **New**: all.\n\n## [1.0.0] - unreleased\n\n- The first.\n"


@pytest.fixture
def release():
    loader = importlib.machinery.SourceFileLoader("release", str(ROOT / "scripts" / "release"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("release", loader))
    loader.exec_module(module)
    return module


@pytest.fixture
def copy(release, tmp_path, monkeypatch):
    """A repository of the files that have the number, all committed."""
    for name in [*release.WRITTEN, "CHANGELOG.md"]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    monkeypatch.setattr(release, "ROOT", tmp_path)
    return tmp_path


def commit(folder):
    identity = ["-c", "user.name=Tests", "-c", "user.email=tests@localhost"]
    for command in (["init", "-q"], ["add", "."], [*identity, "commit", "-q", "-m", "All"]):
        subprocess.run(["git", *command], cwd=folder, check=True)


def test_all_files_have_one_number(release):
    assert {number for file in release.WRITTEN for number in release.numbers(file)} == {VERSION}
    assert all(release.numbers(file) for file in release.WRITTEN)
    assert holomorph.__version__ == VERSION


def test_the_number_is_written_everywhere(release, copy):
    before = {file: len(release.numbers(file)) for file in release.WRITTEN}
    release.write("12.0.3")
    assert {file: set(release.numbers(file)) for file in release.WRITTEN} == dict.fromkeys(release.WRITTEN, {"12.0.3"})
    assert {file: len(release.numbers(file)) for file in release.WRITTEN} == before
    release.write(VERSION)
    assert all((copy / file).read_bytes() == (ROOT / file).read_bytes() for file in release.WRITTEN)


def test_notes_are_those_of_the_version(release):
    assert release.notes("2.0.0", CHANGELOG) == "- **New**: all.\n"
    for version in ("1.0.0", "3.0.0"):
        with pytest.raises(SystemExit, match=rf"\[{version}\]"):
            release.notes(version, CHANGELOG)


def test_what_is_not_ready_is_refused(release, copy):
    with pytest.raises(SystemExit, match="three numbers"):
        release.check("1.0")
    with pytest.raises(SystemExit, match="CITATION.cff has"):
        release.check("2.0.0")
    release.write("2.0.0")
    (copy / "CHANGELOG.md").write_text(CHANGELOG, encoding="utf-8")
    commit(copy)
    assert release.check("2.0.0") == "- **New**: all.\n"
    (copy / "CHANGELOG.md").write_text(CHANGELOG + "- More.\n", encoding="utf-8")
    with pytest.raises(SystemExit, match="not committed"):
        release.check("2.0.0")


def test_what_releases_are_built_with_is_pinned_by_hashes():
    """Everything that scripts/environment asks for to compile and pack, and what that needs."""
    pinned = (ROOT / "scripts" / "release-requirements.txt").read_text(encoding="utf-8")
    entries = [entry.replace("\\\n", "") for entry in re.split(r"\n(?=\w)", re.sub(r"(?m)^#.*\n", "", pinned).strip())]
    assert all(re.match(r"[\w-]+==[\d.]+\s+--hash=sha256:[0-9a-f]{64}", entry) for entry in entries)
    names = {entry.split("==")[0] for entry in entries}
    asked = re.findall(r"make_tools_venv .*", (ROOT / "scripts" / "environment").read_text(encoding="utf-8"))
    wanted = {name for line in asked for name in re.findall(r'"([\w-]+)[>=]=', line)}
    assert {"pybind11", "ziglang", "auditwheel"} <= wanted <= names
