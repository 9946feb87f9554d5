"""The readers of recordings: their speed, their agreement with another reader, and fuzzing."""
