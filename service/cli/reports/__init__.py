"""Reports that the service makes, written to files."""
