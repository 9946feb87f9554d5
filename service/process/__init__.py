"""What the service is as a process: its start and stop, its lock, its name, its logs."""
