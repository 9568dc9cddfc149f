"""What is kept of a run: histories, extremes, reactions, checks."""
