"""The page of a motor: what is wrong with it, how that is known, and what can be done."""
