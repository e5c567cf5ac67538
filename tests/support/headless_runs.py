"""addon/headless.py in a Blender of its own, and what it does in this one."""

import os
import subprocess
import sys

import bpy
import pytest
from loaded_addon import module
from repository import ROOT

BLENDER = os.environ.get("HOLOMORPH_BLENDER", "")
SCRIPT = str(ROOT / "addon" / "headless.py")
SECONDS = 300

# What `blender -b FILE --python SCRIPT` does, where Blender is a Python module. In 4.2 such a module crashes at the end
# of the process where a class is still registered, as Blender's glTF exporter leaves some: it ends without.
AS_MODULE = """
import os, runpy, sys, bpy
blend, script = sys.argv[1:3]
if blend:
    bpy.ops.wm.open_mainfile(filepath=blend)
runpy.run_path(script, run_name="__main__")
sys.stdout.flush()
sys.stderr.flush()
os._exit(0)
"""

needs_program = pytest.mark.skipif(not BLENDER, reason="needs a Blender program: HOLOMORPH_BLENDER names it")


def headless(*arguments, blend="", seconds=SECONDS):
    if BLENDER:
        command = [BLENDER, "-b", "--disable-autoexec", *([str(blend)] if blend else []), "--factory-startup"]
        command += ["--python-exit-code", "1", "--python", SCRIPT]
    else:
        command = [sys.executable, "-c", AS_MODULE, str(blend), SCRIPT]
    command += ["--", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)


def pressed_here(*arguments, blend=""):
    """What the program does, in this Blender: to start another one takes two seconds."""
    if blend:
        bpy.ops.wm.open_mainfile(filepath=str(blend))
    module("headless").process(module("headless").parse([str(argument) for argument in arguments]))


def refusal(*arguments, blend="", status=2):
    """The sentence with which the program ends, for a mistake in the command with status 2; in this Blender."""
    with pytest.raises((ValueError, OSError) if status == 2 else RuntimeError) as refused:
        pressed_here(*arguments, blend=blend)
    return str(refused.value)


def sets(*pairs):
    """The arguments that set properties."""
    return [word for pair in pairs for word in ("--set", pair)]


def our_lines(done):
    return [line for line in done.stderr.splitlines() if line.startswith("holomorph: ")]


def write_obj(path, vertices, faces):
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path
