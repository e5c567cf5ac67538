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
def release(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "scripts")
    loader = importlib.machinery.SourceFileLoader("release", str(ROOT / "scripts" / "release"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("release", loader))
    loader.exec_module(module)
    return module


@pytest.fixture
def copy(release, tmp_path, monkeypatch):
    """A repository of the files that have the number, all committed."""
    for name in {*release.written.NUMBERS, *release.written.ADDRESSES, "CHANGELOG.md"}:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    monkeypatch.setattr(release.written, "ROOT", tmp_path)
    return tmp_path


def commit(folder):
    identity = ["-c", "user.name=Tests", "-c", "user.email=tests@localhost"]
    for command in (["init", "-q"], ["add", "."], [*identity, "commit", "-q", "-m", "All"]):
        subprocess.run(["git", *command], cwd=folder, check=True)


def test_all_files_have_one_number(release):
    written = release.written
    assert {number for file in written.NUMBERS for number in written.numbers(file)} == {VERSION}
    assert all(written.numbers(file) for file in written.NUMBERS)
    assert holomorph.__version__ == VERSION


def test_the_number_is_written_everywhere(release, copy):
    written = release.written
    before = {file: len(written.numbers(file)) for file in written.NUMBERS}
    written.write("12.0.3")
    found = {file: set(written.numbers(file)) for file in written.NUMBERS}
    assert found == dict.fromkeys(written.NUMBERS, {"12.0.3"})
    assert {file: len(written.numbers(file)) for file in written.NUMBERS} == before
    written.write(VERSION)
    assert all((copy / file).read_bytes() == (ROOT / file).read_bytes() for file in written.NUMBERS)


def known(address):
    """The table of pyproject.toml with an address for each name."""
    return {name: f"https://example.org/{name.lower()}" for name in address}


def fill(copy, addresses):
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    table = "[project.urls]\n" + "".join(f'{name} = "{address}"\n' for name, address in addresses.items())
    text = re.sub(r"(?ms)^\[project\.urls\]\n.*?(?=^\[)", table + "\n", text)
    (copy / "pyproject.toml").write_text(text, encoding="utf-8")


def named_in(file):
    return set(re.findall(r"https://example\.org/[\w/.-]+", file.read_text(encoding="utf-8")))


def test_no_file_names_another_address_than_pyproject(release):
    assert set(release.written.addresses()) <= set(release.written.NAMES)
    assert release.written.stale() == []


@pytest.mark.parametrize("left_out", [None, "Homepage", "Documentation", "Issues", "Download"])
def test_addresses_are_written_everywhere_and_those_not_filled_in_nowhere(release, copy, left_out):
    written = release.written
    filled = known(name for name in written.NAMES if name != left_out)
    fill(copy, filled)
    assert written.stale()
    written.write(VERSION)
    assert not written.stale()
    named = {file: named_in(copy / file) for file in written.ADDRESSES}
    assert set(filled.values()) <= named["README.md"] == named["docs/blender/install.md"]
    assert all(any(found.startswith(address) for address in filled.values()) for file in named for found in named[file])
    assert bool(named["CITATION.cff"]) == ("Homepage" in filled)
    assert ("https://example.org/documentation/_images/tiling.jpg" in named["native/README.md"]) == (
        "Documentation" in filled
    )
    fill(copy, {})
    written.write(VERSION)
    assert not any(named_in(copy / file) for file in written.ADDRESSES)
    assert all(
        (copy / file).read_bytes() == (ROOT / file).read_bytes() for file in {*written.ADDRESSES} - {"pyproject.toml"}
    )


def test_the_steps_say_what_is_to_fill_in_and_what_was_not_made(release, copy):
    fill(copy, known(("Homepage", "Issues")))
    said = list(release.steps(VERSION, copy, release.PLATFORMS))
    assert "fill in Documentation, Download" in said[0] and not [step for step in said if "Not made" in step]
    fill(copy, known(release.written.NAMES))
    for name in ("linux_x64", "windows_x64", "blender-3.4"):
        (copy / f"holomorph-{VERSION}-{name}.zip").touch()
    made = release.made_in(copy, release.PLATFORMS)
    assert made == ["windows-x64", "linux-x64"]
    said = list(release.steps(VERSION, copy, made))
    assert [step.split(".")[0] for step in said[:3]] == [
        f"Not made here: {name}" for name in ("macos-arm64", "macos-x64", "linux-arm64")
    ]
    assert not [step for step in said if "their own systems" in step]
    assert [step for step in release.steps(VERSION, copy, ["windows-x64"]) if "their own systems" in step]
    index, platform = (
        next(k for k, step in enumerate(said) if word in step) for word in ("twine", "extension platform")
    )
    assert index < platform


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
    release.written.write("2.0.0")
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
