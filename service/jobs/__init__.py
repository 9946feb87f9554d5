"""Diagnoses made in worker processes, taken from the queue in the database."""
