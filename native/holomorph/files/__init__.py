"""Formats of meshes and images, and files that are written completely or not at all."""
