"""The speed that is seen in line currents, beside an encoder."""
