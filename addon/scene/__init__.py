# SPDX-License-Identifier: GPL-3.0-or-later
"""What is read of Blender's objects: polygons, marks of edges, modifiers, what is chosen."""
