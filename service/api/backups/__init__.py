"""What the API tells of back-ups."""
