"""One relay's text reports: found among its files, fetched now and then, and what they tell kept."""
