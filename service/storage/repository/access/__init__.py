"""Users, their sessions and tokens, and failed logins."""
