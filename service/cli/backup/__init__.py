"""Commands that back a service up, and put a back-up in place."""
