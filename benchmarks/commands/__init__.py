"""How long a person waits for the commands: python -m benchmarks.commands [--runs N]."""
