"""A motor followed from record to record; its state is saved and restored."""
