"""Users, tokens and logins on the command line."""
