"""What a relay measures of its motor and remembers: phasors, starts, events, the relay word."""
