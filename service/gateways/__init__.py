"""Gateways to the plant's other systems. Each is a process of its own that reads the database."""
