"""The collector: many relays, many connections, and how fast it pulls files."""
