# SPDX-License-Identifier: GPL-3.0-or-later
"""A map follows the dials of its object."""


def changed(obj, context):
    pass
