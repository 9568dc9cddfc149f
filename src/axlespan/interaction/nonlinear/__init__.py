"""Contact that lets go and springs that are not linear, in time."""
