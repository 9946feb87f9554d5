"""Users, their sessions, login links and tokens, and failed logins."""
