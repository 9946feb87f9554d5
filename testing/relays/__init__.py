"""Relays to talk to: small ones, simulated ones, their certificates, and what they hold."""
