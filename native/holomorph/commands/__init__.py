"""Commands of the shell beside `batch`."""
