"""Alarms: listed with what to act on first, looked after by people, counted."""
