"""Settings of the service, and what is shown to relays."""
