"""Tells open pages that what they show has changed: one look at the database for all of them."""
