"""What recordings show of rotor and supply, over time."""
