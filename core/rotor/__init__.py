"""Broken rotor bars: the sidebands of one record, and the condition of the cage over many."""
