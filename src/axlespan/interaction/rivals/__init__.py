"""Other couplings, to compare with: iterative, refactored, and N12 as printed."""
