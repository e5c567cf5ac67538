"""What became of an asset."""

DONE = "done"  # some part has its map
REFUSED = "refused"  # no part is a surface, or has what the recipe asks for
MEMORY = "memory"  # more memory was needed than the limit
TIME = "time"  # it took longer than the limit
CRASHED = "crashed"  # its process ended, twice
ALL = (DONE, REFUSED, MEMORY, TIME, CRASHED)
