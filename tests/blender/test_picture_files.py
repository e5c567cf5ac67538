"""The values of image files in Blender are those that the library reads, whatever Blender makes of them to render."""

import struct
import zlib

import bpy
import numpy as np
import pytest
from loaded_addon import module

image_io, relief = module("scene.image_io"), module("things.relief")
holomorph = module("native").load()
KINDS = {0: 1, 2: 3, 4: 2, 6: 4}  # of PNG: grey, colours, each with alpha; channels


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(values, kind, bits, more=b""):
    rows = values.astype(">u2" if bits == 16 else np.uint8)
    content = b"".join(b"\0" + row.tobytes() for row in rows)
    head = struct.pack(">IIBBBBB", values.shape[1], len(values), bits, kind, 0, 0, 0)
    chunks = chunk(b"IHDR", head) + more + chunk(b"IDAT", zlib.compress(content)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


def ramp(channels, most):
    """All grey values alike; alpha, if any, not opaque."""
    grey = np.linspace(0.2, 0.8, 32 * 8).reshape(8, 32)[:, :, None] * most
    values = np.repeat(np.rint(grey), channels, axis=2)
    if channels % 2 == 0:
        values[:, :, -1] = most // 3
    return values


def read(path):
    image = bpy.data.images.load(str(path))
    return image, relief.heights_of(image_io.read_file_values(image), None)


@pytest.mark.parametrize("space", ["sRGB", "Non-Color"])
@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("kind", KINDS)
def test_heights_are_the_values_of_the_file(kind, bits, space, tmp_path):
    values, most = ramp(KINDS[kind], 2**bits - 1), 2**bits - 1
    (tmp_path / "a.png").write_bytes(png(values, kind, bits))
    image = bpy.data.images.load(str(tmp_path / "a.png"))
    image.colorspace_settings.name = space
    before = len(bpy.data.images), image.colorspace_settings.name, image.alpha_mode
    found = relief.heights_of(image_io.read_file_values(image), None)
    assert np.abs(found - values[:, :, 0] / most).max() < 1e-6
    assert (len(bpy.data.images), image.colorspace_settings.name, image.alpha_mode) == before


def test_packed_images_are_files_too(tmp_path):
    values = ramp(1, 65535)
    (tmp_path / "a.png").write_bytes(png(values, 0, 16))
    image = bpy.data.images.load(str(tmp_path / "a.png"))
    image.pack()
    (tmp_path / "a.png").unlink()
    found = relief.heights_of(image_io.read_file_values(image), None)
    assert np.abs(found - values[:, :, 0] / 65535).max() < 1e-6


@pytest.mark.parametrize("turn", range(1, 9))
def test_pictures_are_turned_as_the_command_turns_them(turn, tmp_path):
    values = np.arange(8 * 12).reshape(8, 12, 1) * 2
    exif = b"MM\0*\0\0\0\x08\0\x01" + struct.pack(">HHIHH", 0x0112, 3, 1, turn, 0) + bytes(4)
    (tmp_path / "a.png").write_bytes(png(values, 0, 8, chunk(b"eXIf", exif)))
    _, found = read(tmp_path / "a.png")
    stored = values[:, :, 0] / 255
    assert np.abs(found - holomorph.files.picture_values.upright(stored, turn)).max() < 1e-6
    assert found.shape == ((12, 8) if turn >= 5 else (8, 12))


def test_what_is_too_large_or_out_of_range_is_refused():
    large = bpy.data.images.new("Large", 4, 4)
    large.scale(5000, 4000)
    with pytest.raises(ValueError, match="5000 x 4000 pixels, more than the 16,777,216"):
        image_io.read_file_values(large)
    bpy.data.images.remove(large)
    bright = np.zeros((4, 4, 4), np.float32)
    bright[0, 0] = 3
    with pytest.raises(ValueError, match="from 0 to 1, not from 0 to 3"):
        relief.heights_of(bright, None)
