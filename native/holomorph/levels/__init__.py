"""Progressive meshes and forms by levels."""
