# SPDX-License-Identifier: GPL-3.0-or-later
"""Kept solves, so that the sliders of the redo panel cost one small matrix product and no solve.

A solve is found again by what was solved, geometry and topology with the artist's choices: an object that was moved,
renamed, undone or reopened has the same, one that was edited has not.
"""

SIZE_LIMIT = 150_000_000  # doubles, 1.2 GB; the newest solve is always kept

_kept = []  # pairs of a `solve.Task` and its `SolvedObject`; what was asked for last comes last


def find(task):
    """The kept `SolvedObject` of an equal task, or None."""
    for place, (kept, solved) in enumerate(_kept):
        if kept.equals(task):
            _kept.append(_kept.pop(place))
            return solved
    return None


def keep(task, solved):
    """Keeps a solve and lets the oldest go until the rest fits in `SIZE_LIMIT`. @pre find(task) is None"""
    _kept.append((task, solved))
    while len(_kept) > 1 and sum(s.size for _, s in _kept) > SIZE_LIMIT:
        _kept.pop(0)


def clear():
    _kept.clear()
