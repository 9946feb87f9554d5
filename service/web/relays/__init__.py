"""Pages of relays: their links over time, clocks, records, and what differs from their SCL."""
