"""What the service does in threads of its own: schedules, housekeeping, event reports nobody attends to."""
