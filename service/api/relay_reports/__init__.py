"""Text reports of relays that people bring: starts and load profiles."""
