"""MOTOR.toml, the file of one motor: read, checked and written."""
