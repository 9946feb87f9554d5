"""What the simulated relays cost."""
