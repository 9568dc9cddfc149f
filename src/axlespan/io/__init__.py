"""Meshes, matrices and results, in and out of files."""
