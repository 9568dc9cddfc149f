"""The structure in the coordinates of a reduced basis, and how far that is from the full one."""
