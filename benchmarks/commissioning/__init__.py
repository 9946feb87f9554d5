"""Benchmark: parameters from starts of motors as they are built."""
