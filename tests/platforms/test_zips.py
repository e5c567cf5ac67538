"""What is in the extensions of the five platforms: small, complete, asking for nothing that a system does not have."""

import json
import re
import subprocess
import zipfile

import mach_o
import pytest
import tomllib
from conftest import PLATFORMS, PYTHONS, extension, run, wheels
from repository import ROOT, VERSION

BLENDER = ROOT / "build" / "venv" / "bpy-4.2" / "bin" / "python"  # as a Python module
MOST_MEGABYTES = 3.5  # a wheel, of which an extension has one for each Python
TAGS = {
    "windows-x64": "win_amd64",
    "macos-arm64": "macosx_11_0_arm64",
    "macos-x64": "macosx_11_0_x86_64",
    "linux-x64": "manylinux_2_28_x86_64",
    "linux-arm64": "manylinux_2_28_aarch64",
}
OLDEST_GLIBC = (2, 28)  # what Blender itself needs
GLIBC = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1"}
GLIBC |= {"ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
PROCESSORS = {"linux-x64": "Advanced Micro Devices X86-64", "linux-arm64": "AArch64"}


def module(packages, platform, tag):
    (found,) = packages(platform, tag).glob("holomorph/_native.c*")  # not its type stubs
    return found


def said(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("platform", PLATFORMS)
def test_the_extension_is_small_and_complete(repository, platform, tmp_path):
    path = extension(repository, platform)
    megabytes = path.stat().st_size / 1e6
    print(f"{path.name}: {megabytes:.2f} MB")
    assert megabytes < MOST_MEGABYTES * len(PYTHONS)
    found = wheels(path, tmp_path)
    assert {wheel.name for wheel in found.values()} == {
        f"holomorph-{VERSION}-{t}-{t}-{TAGS[platform]}.whl" for t in PYTHONS
    }
    with zipfile.ZipFile(path) as archive:
        manifest = tomllib.loads(archive.read("holomorph_addon/blender_manifest.toml").decode())
        assert {"holomorph_addon/LICENSE", "holomorph_addon/NOTICE"} <= set(archive.namelist())
    assert manifest["platforms"] == [platform]
    assert sorted(manifest["wheels"]) == sorted(f"./wheels/{wheel.name}" for wheel in found.values())


def test_the_index_has_all_platforms(repository):
    entries = json.loads((repository / "index.json").read_text(encoding="utf-8"))["data"]
    assert sorted(platform for entry in entries for platform in entry["platforms"]) == sorted(PLATFORMS)
    assert all(entry["python_versions"] == ["3.11", "3.13", "3.14"] for entry in entries)


@pytest.mark.parametrize("platform", PLATFORMS)
def test_blender_finds_the_extension_valid(repository, platform):
    (program,) = BLENDER.parents[1].glob(
        "lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    )
    output = run(BLENDER, program, "validate", extension(repository, platform))
    assert "warning" not in output.lower() and "error" not in output.lower(), output


def test_blender_installs_the_extension_of_this_computer(repository, tmp_path):
    install = ROOT / "tests" / "package" / "install_extension.py"
    output = run(BLENDER, install, extension(repository, "linux-x64"), BLENDER_USER_RESOURCES=tmp_path)
    assert f"holomorph: {tmp_path}" in output, output


@pytest.mark.parametrize("tag", PYTHONS)
@pytest.mark.parametrize("platform", PROCESSORS)
def test_linux_modules_ask_for_an_old_glibc_alone(packages, platform, tag):
    path = module(packages, platform, tag)
    assert PROCESSORS[platform] in said("readelf", "--file-header", path)
    needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", said("readelf", "--dynamic", path)))
    assert needed and needed <= GLIBC
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", said("readelf", "--version-info", path))
    assert max((int(major), int(minor)) for major, minor in versions) <= OLDEST_GLIBC


@pytest.mark.parametrize("tag", PYTHONS)
def test_windows_modules_ask_for_windows_and_python_alone(packages, tag):
    output = said("objdump", "--private-headers", module(packages, "windows-x64", tag))
    assert "pei-x86-64" in output
    needed = {name.lower() for name in re.findall(r"DLL Name: (\S+)", output)}
    others = {name for name in needed if not name.startswith("api-ms-win-crt-")}
    assert others <= {"kernel32.dll", "ntdll.dll", tag.replace("cp", "python") + ".dll"}, others
    assert tag.replace("cp", "python") + ".dll" in others


@pytest.mark.parametrize("tag", PYTHONS)
@pytest.mark.parametrize("platform, processor", [("macos-arm64", "arm64"), ("macos-x64", "x86_64")])
def test_macos_modules_ask_for_the_system_alone_and_are_signed(packages, platform, processor, tag):
    data = module(packages, platform, tag).read_bytes()
    library = mach_o.read(data)
    assert library.processor == processor
    assert library.needed == {"/usr/lib/libSystem.B.dylib"}
    assert library.oldest == (11, 0)
    assert b"_PyInit__native" in data
    if processor == "arm64":  # an Apple processor runs nothing that is not signed
        wrong, pages = mach_o.wrong_pages(data, library.signature)
        assert pages > 0 and wrong == 0
