"""The page of notifications: who is told of what, through which channels, and what was sent to whom."""
