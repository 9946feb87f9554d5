"""Our optimisers beside those of others: python -m benchmarks.optimisers."""
