# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command as one of Blender's own: those of an enabled extension are known since 4.2."""

import bpy

NAME = "holomorph"  # blender --command holomorph
_registered = []


def _run(arguments):
    """The exit status."""
    from . import command

    try:
        command.main(arguments, f"blender [file.blend] --command {NAME}")
    except SystemExit as end:
        return end.code or 0
    return 0


def register():
    if bpy.app.version >= (4, 2, 0):
        _registered.append(bpy.utils.register_cli_command(NAME, _run))


def unregister():
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
