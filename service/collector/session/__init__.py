"""The conversation with one relay."""
