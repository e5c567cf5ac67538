"""Harmonic and holomorphic one-forms, the structures that they make, and their certificates."""
