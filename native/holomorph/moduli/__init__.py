"""Period matrices compared: equivalence, automorphisms, invariants, maps between surfaces."""
