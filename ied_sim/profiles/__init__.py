"""Relay profiles: kinds of relay that can be simulated."""
