"""Messages about alarms: what was sent to whom, channels and their tests."""
