"""Heights are the values of the file, whatever its kind; what is no picture, or too large, is refused and starts
nothing."""

import io
import os
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest
from holomorph import height_image
from holomorph.files.picture_values import MOST_PIXELS, brightness, orientation, upright

Image = pytest.importorskip("PIL.Image")
ImageOps = pytest.importorskip("PIL.ImageOps")
GREY, COLOUR, PALETTE, GREY_ALPHA, COLOUR_ALPHA = 0, 2, 3, 4, 6
CHANNELS = {GREY: 1, COLOUR: 3, GREY_ALPHA: 2, COLOUR_ALPHA: 4}


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def predicted(kind, row, above, step):
    """The bytes of a row that each filter of PNG predicts."""
    left = np.concatenate([np.zeros(step, int), row[:-step]])
    corner = np.concatenate([np.zeros(step, int), above[:-step]])
    if kind < 4:
        return [0 * left, left, above, (left + above) // 2][kind]
    away = [np.abs(above - corner), np.abs(left - corner), np.abs(left + above - 2 * corner)]
    return np.where((away[0] <= away[1]) & (away[0] <= away[2]), left, np.where(away[1] <= away[2], above, corner))


def png(values, kind, bits=16, more=b""):
    """(rows, columns, channels) values as a PNG file, whose rows have each of the filters."""
    rows, columns, _ = values.shape
    lines = np.frombuffer(values.astype(">u2" if bits == 16 else np.uint8).tobytes(), np.uint8).reshape(rows, -1)
    step, above, content = CHANNELS[kind] * bits // 8, np.zeros(lines.shape[1], int), b""
    for number, line in enumerate(lines.astype(int)):
        told = (line - predicted(number % 5, line, above, step)) % 256
        content += bytes([number % 5]) + told.astype(np.uint8).tobytes()
        above = line
    head = struct.pack(">IIBBBBB", columns, rows, bits, kind, 0, 0, 0)
    chunks = chunk(b"IHDR", head) + more + chunk(b"IDAT", zlib.compress(content)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


def tiff(values, bits, real=False, compressed=False):
    """(rows, columns, channels) values as an uncompressed TIFF file in little endian."""
    rows, columns, channels = values.shape
    data = values.astype({8: "<u1", 16: "<u2", 32: "<f4" if real else "<u4"}[bits]).tobytes()
    entries = [(256, 4, columns), (257, 4, rows), (258, 3, bits), (259, 3, 1), (262, 3, 2 if channels > 2 else 1)]
    entries += [(273, 4, 0), (277, 3, channels), (278, 4, rows), (279, 4, len(data)), (339, 3, 3 if real else 1)]
    start = 8 + 2 + 12 * len(entries) + 4
    bits_at = start
    if channels > 2:
        entries[2] = (258, 3, bits_at)
        start += 2 * channels
    rest = struct.pack(f"<{channels}H", *[bits] * channels) if channels > 2 else b""
    told = b"".join(
        struct.pack("<HHII", tag, kind, channels if tag == 258 else 1, start if tag == 273 else value)
        for tag, kind, value in entries
    )
    return b"II*\0" + struct.pack("<IH", 8, len(entries)) + told + bytes(4) + rest + data


def read(folder, content, name="a.png"):
    path = folder / name
    path.write_bytes(content)
    return height_image(path)


def numbers(channels, most, seed=1):
    return np.random.default_rng(seed).integers(0, most + 1, (11, 7, channels))


def expected(values, most):
    if values.shape[2] < 3:
        return values[:, :, 0] / most
    return values[:, :, :3] @ (0.2126, 0.7152, 0.0722) / most


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("kind", CHANNELS)
def test_png_keeps_all_bits(kind, bits, tmp_path):
    values = numbers(CHANNELS[kind], 2**bits - 1)
    for more in (b"", chunk(b"sRGB", b"\0"), chunk(b"gAMA", struct.pack(">I", 45455))):
        found = read(tmp_path, png(values, kind, bits, more))
        assert np.abs(found - expected(values, 2**bits - 1)).max() < 1e-12


def test_colours_that_are_grey_are_the_grey(tmp_path):
    values = numbers(1, 65535)
    grey = read(tmp_path, png(values, GREY))
    for kind in (COLOUR, COLOUR_ALPHA):
        colours = np.concatenate([np.repeat(values, 3, axis=2), numbers(CHANNELS[kind] - 3, 65535, 2)], axis=2)
        assert np.array_equal(read(tmp_path, png(colours, kind)), grey)
    assert np.array_equal(read(tmp_path, png(np.concatenate([values, 65535 - values], axis=2), GREY_ALPHA)), grey)


def test_tiff_with_bits_and_reals_of_grey(tmp_path):
    values = numbers(1, 65535)
    assert np.array_equal(read(tmp_path, tiff(values, 16), "a.tif"), values[:, :, 0] / 65535)
    reals = np.float32(values / 65535)
    assert np.array_equal(read(tmp_path, tiff(reals, 32, real=True), "a.tif"), reals[:, :, 0])
    colours = numbers(3, 255)
    assert np.abs(read(tmp_path, tiff(colours, 8), "a.tif") - expected(colours, 255)).max() < 1e-12
    with pytest.raises(ValueError, match="colours or alpha of more than 8 bits"):
        read(tmp_path, tiff(numbers(3, 65535), 16), "a.tif")


@pytest.mark.parametrize("name", ["JPEG", "WEBP", "BMP"])
def test_other_formats_are_read(name, tmp_path):
    grey = np.repeat(np.repeat(np.arange(0, 256, 85, dtype=np.uint8)[None], 32, axis=0), 32, axis=1)
    Image.fromarray(grey).convert("RGB").save(tmp_path / "a", name, **({"lossless": True} if name == "WEBP" else {}))
    assert np.abs(height_image(tmp_path / "a") - grey / 255).max() < 0.02


@pytest.mark.parametrize("turn", range(1, 9))
def test_pictures_are_turned_as_they_are_shown(turn, tmp_path):
    values = np.random.default_rng(turn).integers(0, 256, (16, 24), dtype=np.uint8)
    exif = Image.Exif()
    exif[0x0112] = turn
    for name in ("a.png", "a.jpg"):
        Image.fromarray(values).save(tmp_path / name, exif=exif, **({"quality": 100} if name == "a.jpg" else {}))
        with Image.open(tmp_path / name) as picture:
            shown = np.asarray(ImageOps.exif_transpose(picture))
        assert np.array_equal(height_image(tmp_path / name), shown / 255)
        with Image.open(tmp_path / name) as picture:
            stored = np.asarray(picture)
        told = orientation((tmp_path / name).read_bytes())
        assert told == turn
        assert np.array_equal(upright(stored, told), shown)


def test_a_header_that_is_cut_off_or_wrong_turns_nothing(tmp_path):
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.new("L", (4, 4)).save(tmp_path / "a.jpg", exif=exif)
    content = (tmp_path / "a.jpg").read_bytes()
    assert {orientation(content[:end]) for end in range(len(content))} == {1, 6}
    assert np.array_equal(upright(np.eye(3), 99), np.eye(3))


def test_brightness_is_exact_where_channels_are_alike():
    grey = np.random.default_rng(0).random(1000)
    assert np.array_equal(brightness(grey, grey, grey), grey)


# ---- what is refused ------------------------------------------------------------------------------------------------


def large(side):
    """As small as a file of so many white pixels gets."""
    head = struct.pack(">IIBBBBB", side, side, 1, 0, 0, 0, 0)
    packer = zlib.compressobj(9)
    row = b"\0" + b"\xff" * ((side + 7) // 8)
    content = b"".join(packer.compress(row) for _ in range(side)) + packer.flush()
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", content) + chunk(b"IEND", b"")


POSTSCRIPT = b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 100 100\n%%EndComments\n{} loop\n%%EOF\n"
REFUSED = {
    "postscript.png": (POSTSCRIPT, "not a readable picture"),
    "pdf.png": (b"%PDF-1.4\n", "not a readable picture"),
    "gif.png": (b"GIF89a" + bytes(20), "not a readable picture"),
    "nothing.png": (b"", "not a readable picture"),
    "half.png": (png(numbers(1, 255), GREY, 8)[:60], "not a readable picture"),
    "large.png": (large(5000), "5000 x 5000 pixels, more than the 16,777,216 that are read"),
    "too large for pillow.png": (large(20000), "more than the 16,777,216 that are read"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_picture_is_refused(name, tmp_path):
    content, message = REFUSED[name]
    with pytest.raises(ValueError, match=message) as caught:
        read(tmp_path, content, name)
    assert "\n" not in str(caught.value)


def test_no_program_is_started(tmp_path):
    """Pillow alone would hand PostScript to Ghostscript."""
    (tmp_path / "a.png").write_bytes(POSTSCRIPT)
    code = (
        "import sys; sys.addaudithook(lambda event, _: event in ('subprocess.Popen', 'os.exec') and sys.exit(9));"
        f"import holomorph\ntry: holomorph.height_image({str(tmp_path / 'a.png')!r})\nexcept ValueError: sys.exit(3)"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 3


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.png")
    with pytest.raises(OSError, match="a pipe or a device"):
        height_image(tmp_path / "a.png")


def test_the_largest_that_is_read(tmp_path):
    """White with a black corner: it takes a bounded number of bytes for each pixel."""
    side = int(MOST_PIXELS**0.5)
    found = read(tmp_path, large(side))
    assert found.shape == (side, side)
    assert found.nbytes == 8 * MOST_PIXELS


@pytest.mark.parametrize("name", ["PNG", "JPEG", "TIFF", "WEBP", "BMP"])
def test_any_damage_reads_or_is_refused(name, tmp_path):
    random = np.random.default_rng(3)
    buffer = io.BytesIO()
    Image.fromarray(random.integers(0, 256, (20, 20, 3), dtype=np.uint8)).save(buffer, name)
    for _ in range(150):
        damaged = bytearray(buffer.getvalue())
        if random.random() < 0.3:
            del damaged[random.integers(len(damaged)) :]
        for place in random.integers(max(len(damaged), 1), size=4 if damaged else 0):
            damaged[place] = random.integers(256)
        try:
            found = read(tmp_path, bytes(damaged), "a")
        except ValueError as error:
            assert str(error).startswith("a ")
        else:
            assert found.ndim == 2
