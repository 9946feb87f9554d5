"""The audit trail: entries of who changed what, chained by their hashes, and what is wrong with a chain."""
