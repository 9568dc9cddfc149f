"""Benchmarks: times as medians, and ratios of runs that took turns."""
