"""Element formulas: stiffness, mass and interpolation, vectorized over the elements of a family."""
