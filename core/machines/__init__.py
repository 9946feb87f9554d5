"""Induction machine models with and without shorted turns, and their parameters."""
