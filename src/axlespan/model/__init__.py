"""Finite element models: what they are made of, and how they become systems of matrices."""
