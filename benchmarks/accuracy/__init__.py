"""How exact the diagnosis is, on simulated and on measured records: python -m benchmarks.accuracy."""
