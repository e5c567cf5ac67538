"""addon/headless.py in a Blender of its own, and its command in this one."""

import contextlib
import io
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


def refusal(*arguments, blend="", status=2):
    """The sentence with which the command ends, for a mistake in it with status 2, when it is run in this Blender: to
    start another one takes a second."""
    if blend:
        bpy.ops.wm.open_mainfile(filepath=str(blend))
    said, told = io.StringIO(), io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(told), pytest.raises(SystemExit) as end:
        module("command_line.command").main([str(argument) for argument in arguments])
    (line,) = said.getvalue().splitlines()
    assert (end.value.code, told.getvalue()) == (status, "") and line.startswith("Holomorph: ")
    return line


def our_lines(done):
    return [line for line in done.stderr.splitlines() if line.startswith("Holomorph")]


def write_obj(path, vertices, faces):
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path
