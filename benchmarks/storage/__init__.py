"""The database at the size of a large plant: how long it answers and how others write beside long work."""
