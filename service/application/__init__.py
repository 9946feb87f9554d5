"""The service put together and run: all of it on one data directory, or gateways alone."""
