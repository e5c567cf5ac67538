"""A zip that was made for another Blender or another computer: one sentence says which one is right."""

import zipfile

import pytest
from packages import extension, run
from repository import ROOT

WRONG_ZIP = ROOT / "tests" / "package" / "wrong_zip.py"


def problem(output):
    return next(line for line in output.splitlines() if line.startswith("problem: "))


def test_the_extension_in_blender_3_4(dist, blender, tmp_path):
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "9", "--python", WRONG_ZIP, "--"]
    output = run(*command, extension(dist), BLENDER_USER_SCRIPTS=tmp_path)
    assert problem(output).endswith("is the one whose name ends in blender-3.4.zip"), output
    assert [path.name for path in (tmp_path / "addons").iterdir()] == ["holomorph_addon"], "no files of ours lie about"


def test_the_zip_for_3_4_in_a_later_blender(dist, bpy_python, tmp_path):
    if bpy_python.parts[-3] != "bpy-5.2":
        pytest.skip("the native part for Blender 3.4 serves any with Python 3.11")
    legacy = next(dist.glob("*blender-3.4.zip"))
    output = run(bpy_python, WRONG_ZIP, legacy, BLENDER_USER_RESOURCES=tmp_path)
    assert problem(output).endswith("is the one whose name ends in linux_x64.zip"), output


def test_the_extension_for_another_platform(dist, bpy_python, tmp_path):
    with zipfile.ZipFile(extension(dist)) as archive, zipfile.ZipFile(tmp_path / "windows_x64.zip", "w") as other:
        for info in archive.infolist():
            other.writestr(
                info, archive.read(info).replace(b'platforms = ["linux-x64"]', b'platforms = ["windows-x64"]')
            )
    (tmp_path / "settings").mkdir()
    script = (
        "import bpy, os, sys; bpy.ops.extensions.package_install_files(filepath=sys.argv[-1], repo='user_default');"
    )
    script += "print(*bpy.context.preferences.addons.keys()); sys.stdout.flush(); os._exit(0)"
    output = run(bpy_python, "-c", script, tmp_path / "windows_x64.zip", BLENDER_USER_RESOURCES=tmp_path / "settings")
    # Blender 4.2 on a busy computer may lose what its own program says, and then tells of the end alone.
    assert "This platform (linux-x64) isn't one of (windows-x64)" in output or "not found: holomorph" in output
    assert "holomorph" not in output.splitlines()[-1]
