"""Who may do what: users, their roles, passwords, sessions and tokens."""
