"""A motor's past, for pages and reports: its trend at any scale, its records' phasors, its starts."""
