# SPDX-License-Identifier: GPL-3.0-or-later
"""What a panel advises is tried when it is asked for, since it takes as long as another map, and kept where it costs an
eye less."""

import math

from ..maps.mapped import MappedObject
from ..native import holomorph
from . import report, stored


def tried(target, made):
    """What was `mapped` as advised for a `targets.Target`; a refusal where the map that its report tells of costs no
    more."""
    obj = target.find()
    before = stored.parsed(obj.get(report.PROPERTY))
    if not before or not isinstance(made, MappedObject) or not made.done or stored.is_edited(before, obj.data):
        return made
    after = report.object_report(obj, made)
    if cost(after) < cost(before):
        return made
    return holomorph.Error(f"it would be no better: {stored.verdicts(after)[0].sentence}; the map stays as it is")


def cost(entry):
    """That of the maps of an object to an eye, of its report."""
    found = entry["whole"].get("cost")
    return math.inf if found is None else found
