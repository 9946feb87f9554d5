"""Routes about the gateways to the plant's other systems."""
