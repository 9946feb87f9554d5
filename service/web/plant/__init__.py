"""The page of the plant: what its files say against what its relays say, and the limits that are in force."""
