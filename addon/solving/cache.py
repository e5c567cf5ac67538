# SPDX-License-Identifier: GPL-3.0-or-later
"""A cache of solves, so that the sliders of the redo panel cost one small matrix product and no solve.

The key is what was solved, geometry and topology with the choices on it: an object that was moved, renamed, undone or
reopened has the same, one that was edited has not.
"""

SIZE_LIMIT = 150_000_000  # doubles, 1.2 GB; the newest solve stays even if it is larger

_entries = []  # pairs of a `solve.Task` and its `SolvedObject`, the least recently used first


def find(task):
    """The `SolvedObject` of an equal task, or None."""
    for place, (known, solved) in enumerate(_entries):
        if known.equals(task):
            _entries.append(_entries.pop(place))
            return solved
    return None


def keep(task, solved):
    """Adds a solve and drops the least recently used ones that exceed `SIZE_LIMIT`. @pre find(task) is None"""
    _entries.append((task, solved))
    trim()


def trim():
    """Again after solves have grown: by tilers and their tilings."""
    while len(_entries) > 1 and sum(s.size for _, s in _entries) > SIZE_LIMIT:
        _entries.pop(0)


def clear():
    _entries.clear()
