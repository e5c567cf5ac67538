"""Registration, and what is said where the native part is missing."""

import signal
from pathlib import Path

import bpy
import pytest
from loaded_addon import module
from scenes import torus


def test_panels_and_menus_are_there():
    for name in ("HOLOMORPH_PT_view3d", "HOLOMORPH_PT_image"):
        panel = getattr(bpy.types, name)
        assert panel.bl_category == "Holomorph" and panel.bl_region_type == "UI"
    draw = module("interface.panel")._draw_menu_entry
    for name in ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs"):
        functions = getattr(bpy.types, name).draw._draw_funcs
        assert draw in functions


def test_unregister_leaves_nothing(addon):
    addon.unregister()
    assert not hasattr(bpy.types, "HOLOMORPH_PT_view3d")
    draw = module("interface.panel")._draw_menu_entry
    assert draw not in bpy.types.VIEW3D_MT_uv_map.draw._draw_funcs
    addon.register()
    assert hasattr(bpy.types, "HOLOMORPH_PT_view3d")


def test_the_solvers_are_those_of_the_library():
    items, native = module("operators.properties").SOLVERS, module("native")
    assert [name for name, *_ in items] == list(native.load().SOLVERS)
    torus()
    with pytest.raises(TypeError, match="guess"):
        bpy.ops.uv.holomorphic_maps(solver="guess")


def test_evenness_has_one_default():
    default = module("maps.mapped").Request.evenness
    for operator in (bpy.ops.uv.holomorphic_maps, bpy.ops.uv.holomorphic_tile):
        found = operator.get_rna_type().properties["evenness"]
        assert found.default == pytest.approx(default) and found.description  # single precision


@pytest.fixture
def without_native_part(addon, monkeypatch):
    native = module("native")

    def missing():
        raise native.NativeMissing(f"Holomorph's native part for {native._looked_for()} is not installed")

    addon.unregister()
    monkeypatch.setattr(native, "_find", missing)
    addon.register()
    yield native
    monkeypatch.undo()
    native.forget()


def test_registration_survives_a_missing_native_part(without_native_part):
    torus()
    sentence = without_native_part.problem()
    assert "Python 3." in sentence and "not installed" in sentence
    assert not bpy.ops.uv.holomorphic_maps.poll()
    with pytest.raises(RuntimeError, match="not installed"):
        bpy.ops.uv.holomorphic_maps()


@pytest.mark.parametrize(
    "blender, computer, tag, end",
    [
        ((4, 2, 0), ("Windows", "AMD64"), "cp311", "ends in windows_x64.zip"),
        ((5, 2, 0), ("Darwin", "arm64"), "cp313", "ends in macos_arm64.zip"),
        ((4, 2, 0), ("Linux", "aarch64"), "cp311", "ends in linux_arm64.zip"),
        ((3, 4, 1), ("Linux", "x86_64"), "cp311", "ends in blender-3.4.zip"),
        ((3, 6, 0), ("Windows", "AMD64"), "cp311", "needs Blender 4.2 or newer"),
        ((5, 2, 0), ("Linux", "x86_64"), "cp315", "scripts/build"),
        ((5, 2, 0), ("FreeBSD", "amd64"), "cp313", "scripts/build"),
    ],
)
def test_the_right_zip_is_named(blender, computer, tag, end):
    assert module("native").right_zip(blender, *computer, tag).endswith(end)


def test_the_right_zip_is_named_with_the_place_where_it_is(monkeypatch):
    monkeypatch.setattr(module("addresses"), "DOWNLOAD", "https://example.org/zips")
    sentence = module("native").right_zip((4, 2, 0), "Windows", "AMD64", "cp311")
    assert "is the one at https://example.org/zips whose name ends in windows_x64.zip" in sentence


def test_the_command_of_an_extension_is_known_where_blender_has_such(capsys):
    """Since 4.2; its exit status is returned, not raised."""
    headless = module("headless")
    assert len(headless._commands) == (bpy.app.version >= (4, 2, 0))
    heard = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    assert headless.main(["--bogus"]) == 2
    assert "--bogus" in capsys.readouterr().err
    assert headless.main(["--help"]) == 0
    assert capsys.readouterr().out.startswith("usage: holomorph ")
    for number, listener in heard.items():  # a program that ends listens no more
        signal.signal(number, listener or signal.SIG_DFL)


def test_the_sentence_of_a_missing_native_part_names_the_zip(addon, monkeypatch):
    native = module("native")
    monkeypatch.setattr(native, "NAME", "nothing_of_this_name")
    native.forget()
    assert "is not installed: the zip to install in this Blender" in native.problem()
    monkeypatch.undo()
    native.forget()
    assert native.problem() == ""


def test_a_broken_native_part_is_named(addon, monkeypatch):
    native = module("native")

    def broken():
        raise ImportError("libsomething.so: cannot open shared object file")

    monkeypatch.setattr(native, "_find", broken)
    native.forget()
    assert "libsomething.so" in native.problem() and "does not load" in native.problem()
    monkeypatch.undo()
    native.forget()
    assert native.problem() == ""


def test_the_manifest_and_bl_info_agree(addon):
    text = (Path(addon.__file__).parent / "blender_manifest.toml").read_text(encoding="utf-8")
    version = ".".join(map(str, addon.bl_info["version"]))
    assert f'version = "{version}"' in text
    assert f'tagline = "{addon.bl_info["description"]}"' in text
