"""Put the add-on and its wheels into the zips that Blender installs: make_zips.py FOLDER WHEEL..."""

import re
import shutil
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon"
LEGACY_TAG = "cp311"  # the Python of Debian's Blender 3.4
# Not "holomorph": Blender puts the folder's parent on the import path, where it would hide the package of that name.
LEGACY_FOLDER = "holomorph_addon"
DATE = (2000, 1, 1, 0, 0, 0)  # the same for every file: the same sources give the same zip


def addon_files():
    """The add-on's own files by their name inside it, and the licences."""
    files = {
        str(path.relative_to(ADDON)): path.read_bytes()
        for path in ADDON.rglob("*")
        if path.is_file() and not {"__pycache__", "lib", "wheels"} & set(path.relative_to(ADDON).parts)
    }
    return files | {name: (ROOT / name).read_bytes() for name in ("LICENSE", "NOTICE")}


def with_wheels(manifest, wheels):
    """The manifest naming these wheels; the list is a key of the top table, so it comes before any other table."""
    if re.search(r"^wheels\s*=", manifest, re.MULTILINE):
        raise SystemExit("make_zips.py: blender_manifest.toml lists wheels; the list is written here")
    lines = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    table = re.search(r"^\[", manifest, re.MULTILINE)
    end = table.start() if table else len(manifest)
    return f"{manifest[:end].rstrip()}\nwheels = [\n{lines}]\n\n{manifest[end:]}"


def write_zip(path, files):
    with zipfile.ZipFile(path, "w") as archive:
        for name in sorted(files):
            # A wheel is compressed already.
            method = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            info = zipfile.ZipInfo(name, DATE)
            info.external_attr = 0o644 << 16
            archive.writestr(info, files[name], method)
    print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


def write_extension(folder, version, wheels):
    files = addon_files()
    manifest = files["blender_manifest.toml"].decode()
    files["blender_manifest.toml"] = with_wheels(manifest, wheels).encode()
    files |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    write_zip(folder / f"holomorph-{version}.zip", files)


def write_legacy(folder, version, wheel):
    files = addon_files()
    del files["blender_manifest.toml"]
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/") and ".dist-info/" not in name]
        files |= {f"lib/{LEGACY_TAG}/{name}": archive.read(name) for name in names}
    write_zip(
        folder / f"holomorph-{version}-blender-3.4.zip",
        {f"{LEGACY_FOLDER}/{name}": data for name, data in files.items()},
    )


def main(folder, *wheels):
    folder, wheels = Path(folder), [Path(wheel) for wheel in wheels]
    for wheel in wheels:
        shutil.copy(wheel, folder)
    version = re.search(
        r'^version = "(.*)"', (ADDON / "blender_manifest.toml").read_text(encoding="utf-8"), re.MULTILINE
    )[1]
    write_extension(folder, version, wheels)
    legacy = [wheel for wheel in wheels if f"-{LEGACY_TAG}-" in wheel.name]
    if legacy:
        write_legacy(folder, version, legacy[0])


if __name__ == "__main__":
    main(*sys.argv[1:])
