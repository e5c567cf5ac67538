# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command: its options, files of other programs, a photo studio."""
