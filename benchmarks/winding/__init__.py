"""Shorted turns inside one coil: a circuit for every coil against the equations of two numbers."""
