"""How well a motor is judged over time, on simulated and measured records: python -m benchmarks.condition."""
