"""Commands on the files of a plant: made, checked and shown."""
