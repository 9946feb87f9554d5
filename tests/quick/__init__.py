"""The tests that a change can break most directly, within a minute: `make quick`."""
