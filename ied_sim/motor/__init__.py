"""The simulated motor: supply, contactor, windings, load, sensors."""
