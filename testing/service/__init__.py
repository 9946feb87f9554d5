"""The service seen from outside: its processes, a small plant and a small record."""
