"""Losses and efficiency of a motor in one record, and what of them its faults cost."""
