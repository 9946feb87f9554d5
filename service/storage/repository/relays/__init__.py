"""Relays: who visits which, their links and clocks, the records they list, and those that are set aside."""
