"""The filter of what stands, and the bank of changes that run beside it."""
