# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command's bake of the objects that got tilings, into images in a folder."""

import bpy

from .. import native
from ..baking import bake, write
from ..baking.channels import BakeOptions
from ..writing import transaction
from .options import Refused


def add(options, outcome):
    """Bakes them, and adds to the report's entries what was baked, to the problems what was not. @throws Refused"""
    reasons = {name: bake.why_not(bpy.data.objects[name]) for name in outcome.done}
    outcome.problems += [f"{name}: not baked: {reason}" for name, reason in reasons.items() if reason]
    objects = [bpy.data.objects[name] for name, reason in reasons.items() if not reason]
    if not objects:
        return
    options.bake.mkdir(exist_ok=True)
    channels = frozenset(name.upper() for name in options.bake_channels)
    folder = str(options.bake.resolve())
    wanted = BakeOptions(channels, options.bake_images.upper(), options.texels, options.bake_margin, folder)
    work = bake.BakeWork(bpy.context, bake.one_of_each_mesh(objects), wanted)
    work.run()
    if work.error:
        raise Refused(f"--bake: {native.sentence(work.error)}") from work.error
    with transaction.one_step(bpy.context, objects) as step:
        made = write.write(step, work, wanted)
    for entry in made.entries:
        (own,) = (one for one in outcome.entries if one["object"] == entry["object"])
        own["baked"] = {key: value for key, value in entry.items() if key != "object"}
    outcome.notes += made.notes
