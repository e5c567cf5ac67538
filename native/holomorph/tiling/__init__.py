"""Seamless tilings, their direction and their evenness."""
