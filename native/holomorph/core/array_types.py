"""Names of types of arguments and results, for type checkers."""

import os
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Reals: TypeAlias = NDArray[np.float64]
Complexes: TypeAlias = NDArray[np.complex128]
Integers: TypeAlias = NDArray[np.signedinteger[Any]]
Flags: TypeAlias = NDArray[np.bool_]
Bounds: TypeAlias = tuple[Reals, Reals]
Progress: TypeAlias = Callable[[float, str], object]
FilePath: TypeAlias = str | os.PathLike[str]
