"""Scenario files: the motor, its condition and its relay's configuration for each IED."""
