# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the project is found. `scripts/release --number` writes this from pyproject.toml; empty: nowhere yet."""

DOCUMENTATION = ""
DOWNLOAD = ""
