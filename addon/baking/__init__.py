# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking: what a tiling shows, in images of an atlas without overlap."""
