"""A motor's past, for pages and reports: its trend at any scale, what its records showed, starts, days."""
