"""A folder with every name and every kind of entry that a file system takes."""

import os
from pathlib import Path

from batch_runs import torus_obj

LONG = "n" * 251
SCRIPTS = {  # as many whole letters as 251 bytes hold
    "Cyrillic": "ж" * 125,
    "Han": "環" * 83,
    "emoji": "🍩" * 62,
    "Devanagari": "क्षि" * 20,
    "Persian": "می‌خواهم" * 14,
    "Latin": LONG,
    "Latin, another end": LONG[:-1] + "m",
}
NAMES = [
    "<!--<script>alert(1)<!--.obj",
    "<script>document.title = 'attacked'</script>.obj",
    "<img src=x onerror=alert(1)>.obj",
    "\"quoted\" 'twice' `thrice`.obj",
    "two\nlines.obj",
    "tab\tand\rreturn.obj",
    "\x1b[2J\x1b]0;attacked\x07.obj",
    "\x01\x7f.obj",
    "=1+1.obj",
    "+1.obj",
    "-1.obj",
    "@SUM(A1).obj",
    "--retry.obj",
    "A.obj",
    "a.obj",
    "A.OBJ",
    "a.Obj",
    "e\u0301.obj",
    "\u00e9.obj",
    "\u202etxt.obj",
    "per%cent%2F.obj",
    "back\\slash\\x41.obj",
    "back\\slashA.obj",
    "[magic]*?.obj",
    "caret^.obj",
    " blanks .obj",
    "...obj",
    ".hidden.obj",
    "CON.obj",
    "a:b|c?d*e.obj",
    "=cmd|' \u2028C'!A0.obj",
    *(f"{letters}.obj" for letters in SCRIPTS.values()),
]
BYTES = [b"\xff\xfe.obj", b"caf\xe9.obj", b"\xc3.obj", b"\xed\xa0\x80.obj", b"\xff" * 251 + b".obj"]
FOLDERS = ["deep/" * 100, f"{LONG}/{LONG}/", "folder.obj/", "Folder.obj/", "space /", "dot./", "\n/", "<b>/", "~^/"]


def any_names(folder):
    """The names, relative to the folder, of what is a mesh: those that this file system takes, as it lists them."""
    folder.mkdir()
    mesh = torus_obj(folder.with_name(f"{folder.name}_mesh.obj"), 8, 6).read_bytes()
    paths = [os.fsencode(name) for name in NAMES] + BYTES + [os.fsencode(f"{place}part.obj") for place in FOLDERS]
    paths += [b"folder.obj/mesh.obj", b"sub/A.obj", b"SUB/a.obj", b"sub/a.obj"]
    for path in paths:
        place = os.path.join(os.fsencode(folder), path)
        try:
            os.makedirs(os.path.dirname(place), exist_ok=True)
            with open(place, "xb") as file:
                file.write(mesh)
        except OSError:  # this file system does not take the name, or takes it for another one
            continue
    return [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()]


def any_entries(folder):
    """({name: status} of what is not a file of a mesh, and of links)"""
    (folder / "entries").mkdir()
    made = {}

    def entry(name, status, make):
        try:
            make(folder / "entries" / name)
        except (PermissionError, OSError):  # no such entries on this file system
            return
        made[f"entries/{name}"] = status

    blob = folder / "entries" / "blob"
    torus_obj(blob, 8, 6)
    (folder / "entries" / "empty.obj").touch()
    made["entries/empty.obj"] = "refused"
    entry("linked.obj", "done", lambda path: path.symlink_to(blob))
    entry("linked twice.obj", "done", lambda path: path.symlink_to("linked.obj"))
    entry("dangling.obj", "refused", lambda path: path.symlink_to("nowhere.obj"))
    entry("circular.obj", "refused", lambda path: path.symlink_to("circular.obj"))
    entry("pipe.obj", "refused", os.mkfifo)
    entry("socket.obj", "refused", _socket)
    entry("null.obj", "refused", lambda path: path.symlink_to("/dev/null"))
    for name, target in (("up", ".."), ("here", "."), ("again", "up"), ("gone", "nowhere"), ("folder.ply", ".")):
        try:
            (folder / "entries" / name).symlink_to(target)
        except OSError:
            break
    return made


def _socket(path):
    import socket

    with socket.socket(socket.AF_UNIX) as made:
        there = os.getcwd()
        os.chdir(Path(path).parent)  # its address may have no more than 108 bytes
        try:
            made.bind(path.name)
        finally:
            os.chdir(there)
