"""A collector under a seeded schedule of faults, and whether anything was lost, doubled or falsified.

`python -m tests.chaos --seed 1 --minutes 2 --recordings 300` or `make chaos`.
docs/evidence/track-record.md says what is done and what came of it.
"""
