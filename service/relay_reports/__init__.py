"""What text reports of motor relays tell of their motors, kept: starts, load, statistics, events."""
