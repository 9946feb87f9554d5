"""The experiments of the thesis repeated: python -m benchmarks.thesis."""
