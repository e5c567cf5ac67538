# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of Blender's meshes, by their types."""

import numpy as np

# The name, type and number of an element's values.
VALUES = {
    "FLOAT": ("value", np.float32),
    "INT": ("value", np.int32),
    "INT8": ("value", np.int32),
    "BOOLEAN": ("value", bool),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
}
