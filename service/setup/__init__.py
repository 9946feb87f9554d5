"""Setting up a plant: checks its files, asks its relays what they offer, writes files to fill in."""
