"""How right figures of the supply, relays' trip times and temperatures of windings are, and how quick."""
