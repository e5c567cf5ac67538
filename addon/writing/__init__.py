# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing to Blender in one step: everything, or nothing."""
