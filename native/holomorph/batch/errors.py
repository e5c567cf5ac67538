"""What became of an asset; and the errors that end the command line, with one sentence each."""

DONE = "done"  # some part has its map
REFUSED = "refused"  # no part is a surface, or has what the recipe asks for
MEMORY = "memory"  # more memory was needed than the limit
TIME = "time"  # it took longer than the limit
CRASHED = "crashed"  # its process ended, twice
ALL = (DONE, REFUSED, MEMORY, TIME, CRASHED)


class UsageError(Exception):
    """What the user asked for cannot be done; nothing was written."""


class StorageError(Exception):
    """Results cannot be written. What is done stays done; the same command goes on when there is space."""


class EngineError(Exception):
    """What does the work is gone. What is done stays done; the same command goes on when it is back."""
