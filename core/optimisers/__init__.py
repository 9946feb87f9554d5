"""Global and local search. Every optimiser returns scipy's OptimizeResult."""
