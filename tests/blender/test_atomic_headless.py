"""The headless command leaves no half of a file: with an error at any line that runs from the first write on, each file
is as before or whole, and the scene is as before where the maps were being written.
"""

import json

import bpy
import pytest
from injection import check
from loaded_addon import module
from scenes import two_objects

OLD = "an earlier one"
ERRORS = (SystemExit, MemoryError, KeyboardInterrupt)  # errors that are told end the command


@pytest.mark.usefixtures("kept_solves")
@pytest.mark.parametrize("options", [["--main", "balanced"], ["--seamless", "--tiles", "20"]])
def test_files_are_whole_or_as_before(tmp_path, options):
    two_objects()
    output, report = tmp_path / "out.blend", tmp_path / "report.json"

    def command():
        for file in (output, report):
            file.write_text(OLD)
        arguments = ["--seams", "--shape", *options, "--output", str(output), "--report", str(report)]
        module("command_line.command").main(arguments)
        return {"FINISHED"}

    def files_are_whole():
        is_made = output.read_bytes() != OLD.encode()
        if is_made:
            with bpy.data.libraries.load(str(output)) as (there, _):
                assert {"Torus", "Ball"} <= set(there.objects)
        if report.read_text() != OLD:  # it tells of maps that are in the file
            assert is_made and all(entry["done"] for entry in json.loads(report.read_text())["objects"])

    check(command, raises=ERRORS, then=files_are_whole)
