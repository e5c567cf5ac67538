# SPDX-License-Identifier: GPL-3.0-or-later
"""What is chosen on a mesh, its conformal structures, which are kept, and worker threads. Arrays only, no bpy."""
