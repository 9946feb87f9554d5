"""Recording requests: what somebody asked a relay to record."""
