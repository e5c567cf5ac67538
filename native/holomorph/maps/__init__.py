"""The choice of a map for each part of a surface, and all maps of a selection."""
