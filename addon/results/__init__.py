# SPDX-License-Identifier: GPL-3.0-or-later
"""What is written to objects: maps, reports, attributes, empties; and taken away again."""
