"""The condition of a motor over time, judged from its records in their order."""
