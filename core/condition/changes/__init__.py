"""What has changed: signatures of the kinds, detector, naming and level."""
