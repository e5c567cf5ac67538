# SPDX-License-Identifier: GPL-3.0-or-later
"""Things made of a tiling: pieces of geometry, one at each place."""
