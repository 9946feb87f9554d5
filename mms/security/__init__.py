"""Who may connect: TLS certificates and passwords."""
