"""The errors that end the command line, with one sentence each."""


class UsageError(Exception):
    """What the user asked for cannot be done; nothing was written."""


class StorageError(Exception):
    """Results cannot be written. What is done stays done; the same command goes on when there is space."""


class EngineError(Exception):
    """What does the work is gone. What is done stays done; the same command goes on when it is back."""
