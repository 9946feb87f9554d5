"""Text reports of relays that people bring: starts, load profiles, statistics and events."""
