"""A library of meshes mapped by one command: `holomorph batch SOURCE... --out DIR`. See docs/batch.md.

sources : what there is to map      recipe : what is wanted of each asset      task : an asset, or a scene of assets
mapping, picture : its maps, its picture     journal : results, whole or not at all
worker : a process that may fail, and what watches it     machine, cluster : many of them, here and on Dask
overview : index.html and the summaries                   command : the command line
"""

DONE = "done"  # some part has its map
REFUSED = "refused"  # no part is a surface, or has what the recipe asks for
MEMORY = "memory"  # more memory was needed than the limit
TIME = "time"  # it took longer than the limit
CRASHED = "crashed"  # its process ended, twice
ALL = (DONE, REFUSED, MEMORY, TIME, CRASHED)  # what may become of an asset


class UsageError(Exception):
    """What the user asked for cannot be done; nothing was written."""


class StorageError(Exception):
    """Results cannot be written. What is done stays done; the same command goes on when there is space."""


class EngineError(Exception):
    """What does the work is gone. What is done stays done; the same command goes on when it is back."""
