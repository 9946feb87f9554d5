"""Relays: their links, clocks and what they offer, and the end of a quarantine."""
