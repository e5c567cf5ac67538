"""What the native core computed, and how to compute it again."""

from functools import cached_property


class Solution:
    """What the native core computed for a structure. A pickle has the call instead that computes the structure: it is
    made where more is asked for than the pickle has, and gives the same bits."""

    def __init__(self, native):
        self.native, self.compute = native, None

    @cached_property
    def native(self):
        return self.compute()._native

    def __getstate__(self):
        return {"compute": self.compute}
