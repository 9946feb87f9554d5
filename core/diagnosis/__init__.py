"""Diagnose one recording: quality gate, search, refinement, verdict."""
