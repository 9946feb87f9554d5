"""The REST API seen from a client: requests, and answers in words."""
