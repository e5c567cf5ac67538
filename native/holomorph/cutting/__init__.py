"""Maps in pieces: cuts, hard edges, cones."""
