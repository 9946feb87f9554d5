"""The conditions of motors over time, and what people tell of motors."""
