"""Starts of a motor: how long it takes to run up, and what it draws meanwhile."""
