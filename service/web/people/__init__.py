"""Pages of people: the own account, and for who manages them, users and tokens."""
