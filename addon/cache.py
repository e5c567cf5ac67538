# SPDX-License-Identifier: GPL-3.0-or-later
"""Kept solves, so that the sliders of the redo panel cost one small matrix product and no solve.

The key is `solve.Task.key`, the fingerprint of geometry and topology with the artist's choices: an object that was
moved, renamed, undone or reopened is found again, one that was edited is not.
"""

from collections import OrderedDict

SIZE_LIMIT = 150_000_000  # doubles, 1.2 GB; the newest solve is always kept

_kept = OrderedDict()


def find(key):
    """The kept `SolvedObject`, or None."""
    if key in _kept:
        _kept.move_to_end(key)
    return _kept.get(key)


def keep(key, solved):
    """Keeps a solve and lets the oldest go until the rest fits in `SIZE_LIMIT`."""
    _kept[key] = solved
    _kept.move_to_end(key)
    while len(_kept) > 1 and sum(s.size for s in _kept.values()) > SIZE_LIMIT:
        _kept.popitem(last=False)


def clear():
    _kept.clear()
