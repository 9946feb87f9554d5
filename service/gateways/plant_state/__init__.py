"""What gateways tell of the plant, and when it changes, whatever protocol they speak."""
