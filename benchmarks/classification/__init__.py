"""Causes told apart, in single records of simulated motors and of measured ones."""
