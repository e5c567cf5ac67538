# SPDX-License-Identifier: GPL-3.0-or-later
"""What a panel advises is tried when it is asked for, since it takes as long as another map, and kept where it costs an
eye less."""

import numpy as np

from ..maps.mapped import MappedObject
from ..native import holomorph
from ..scene import stored_dials
from . import report


def tried(target, made):
    """What was `mapped` as advised for a `targets.Target`; a refusal where its map costs no more."""
    obj = target.find()
    before = stored_dials.made(obj)
    if not before or not isinstance(made, MappedObject) or not made.done or report.is_edited(obj):
        return made
    after = report.object_report(obj, made)
    if np.float32(report.cost(after)) < before.cost:  # in the precision of properties
        return made
    return holomorph.Error(f"it would be no better: {after['verdict']['sentence']}; the map stays as it is")
