"""Commands on the condition of motors over time."""
