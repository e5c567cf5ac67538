"""How good a map is: distortion, overlaps, coarse places, verdicts in words."""
