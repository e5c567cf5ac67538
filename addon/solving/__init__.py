# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves: what is chosen on a mesh, its conformal structures, a cache of them, worker threads. Arrays only, no bpy."""
