# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps out of solves, and measures of maps."""
