"""Measurements that a person can repeat, one folder a subject; `python -m benchmarks` runs the short ones."""
