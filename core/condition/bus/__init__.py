"""Motors of one bus, which share their supply, compared with each other."""
