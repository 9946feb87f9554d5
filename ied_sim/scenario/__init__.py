"""Scenario files: which motors and relays are simulated, and what happens to them."""
