"""Put the add-on and its wheels into the zips that Blender installs, one a platform: make-zips.py FOLDER WHEEL...

The wheels are those of the package index, byte for byte: the extension platform asks for that.
"""

import re
import shutil
import sys
import zipfile
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon"
# Blender's names of platforms, by the end of a wheel's name.
PLATFORMS = {
    "win_amd64": "windows-x64",
    "macosx_11_0_arm64": "macos-arm64",
    "macosx_11_0_x86_64": "macos-x64",
    "_x86_64": "linux-x64",
    "_aarch64": "linux-arm64",
}
LEGACY = ("linux-x64", "cp311")  # Debian's Blender 3.4 and its Python
LEGACY_ONLY = "folders.py"  # imports packages from folders; an extension has wheels
# The folder in all zips. Blender 4.2 and later take the files out of it; an older one that is given their zip makes an
# add-on of it, which says which zip is right. Not "holomorph": such a Blender puts the folder's parent on the import
# path, where it would hide the package of that name.
FOLDER = "holomorph_addon"
DATE = (2000, 1, 1, 0, 0, 0)  # the same for every file: the same sources give the same zip


def platform_of(wheel):
    return next(platform for end, platform in PLATFORMS.items() if wheel.stem.endswith(end))


def website():
    """The address that pyproject.toml has for readers; None while it has none."""
    with open(ROOT / "pyproject.toml", "rb") as file:
        return tomllib.load(file)["project"]["urls"].get("Homepage")


def addon_files():
    """The add-on's own files by their name inside it, and the licences."""
    files = {
        str(path.relative_to(ADDON)): path.read_bytes()
        for path in ADDON.rglob("*")
        if path.is_file() and not {"__pycache__", "lib", "wheels"} & set(path.relative_to(ADDON).parts)
    }
    return files | {name: (ROOT / name).read_bytes() for name in ("LICENSE", "NOTICE")}


def completed(manifest, platform, wheels, website):
    """The manifest of one platform, naming its wheels in the same table, which comes before any other, and the website
    where there is one."""
    if re.search(r"^wheels\s*=", manifest, re.MULTILINE):
        raise SystemExit("make-zips.py: blender_manifest.toml lists wheels; the list is written here")
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    lines = f'platforms = ["{platform}"]\nwheels = [\n{names}]' + (f'\nwebsite = "{website}"' if website else "")
    manifest, found = re.subn(r"^platforms = \[[^]]*\]$", lines, manifest, flags=re.MULTILINE)
    if found != 1:
        raise SystemExit("make-zips.py: blender_manifest.toml does not list the platforms")
    return manifest


def write_zip(path, files):
    with zipfile.ZipFile(path, "w") as archive:
        for name in sorted(files):
            method = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            info = zipfile.ZipInfo(f"{FOLDER}/{name}", DATE)
            info.external_attr = 0o644 << 16
            archive.writestr(info, files[name], method)
    print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


def write_extension(folder, version, platform, wheels):
    files = addon_files()
    del files[LEGACY_ONLY]
    manifest = files["blender_manifest.toml"].decode()
    files["blender_manifest.toml"] = completed(manifest, platform, wheels, website()).encode()
    files |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    write_zip(folder / f"holomorph-{version}-{platform.replace('-', '_')}.zip", files)


def write_legacy(folder, version, wheel):
    files = addon_files()
    del files["blender_manifest.toml"]
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/") and ".dist-info/" not in name]
        files |= {f"lib/{LEGACY[1]}/{name}": archive.read(name) for name in names}
    write_zip(folder / f"holomorph-{version}-blender-3.4.zip", files)


def main(folder, *names):
    folder, wheels = Path(folder), [Path(name) for name in names]
    manifest = (ADDON / "blender_manifest.toml").read_text(encoding="utf-8")
    version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE)[1]
    for wheel in wheels:
        shutil.copy(wheel, folder)
    for platform in dict.fromkeys(PLATFORMS.values()):
        own = [wheel for wheel in wheels if platform_of(wheel) == platform]
        if own:
            write_extension(folder, version, platform, own)
    for wheel in wheels:
        if (platform_of(wheel), wheel.name.split("-")[2]) == LEGACY:
            write_legacy(folder, version, wheel)


if __name__ == "__main__":
    main(*sys.argv[1:])
