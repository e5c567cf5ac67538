"""Points, lines and cells on the tiles of a map, and relief."""
