"""Parameters of a motor over the records of its running: resistances, inductances, and their drift."""
