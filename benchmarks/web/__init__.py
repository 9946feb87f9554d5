"""What the pages cost: times of answers and of the browser, sizes, and what many viewers add."""
