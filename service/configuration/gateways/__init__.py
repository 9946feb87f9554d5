"""Settings of the gateways to the plant's other systems, one module for each."""
