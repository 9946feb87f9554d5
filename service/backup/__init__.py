"""Back-ups of database and recordings while the service runs, their verification, and restoring them."""
