"""The pages of the documentation: their links, commands and drawings."""
