# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that show a map: patterns, images, nodes; and the views that show them."""
