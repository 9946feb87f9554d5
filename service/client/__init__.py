"""A client of the REST API, and its answers in words."""
