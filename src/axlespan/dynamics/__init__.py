"""Time integration of matrices: the alpha method."""
