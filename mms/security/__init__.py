"""Access to a relay: TLS certificates and passwords."""
