"""Surfaces: checked, repaired, cut, compared and copied."""
