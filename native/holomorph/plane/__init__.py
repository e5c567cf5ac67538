"""Maps of disks, rectangles and spheres, and surfaces that are cut open."""
