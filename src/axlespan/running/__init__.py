"""Running lines: where wheels run, in the degrees of freedom of a structure."""
