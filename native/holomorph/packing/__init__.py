"""Where maps lie in the plane."""
