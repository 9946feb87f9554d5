"""Parameters of a motor from the recording of its start (thesis chapter 5)."""
