"""Makes the typed client `statorwatch_client` from the service's OpenAPI document."""
