"""Periodic work in threads of the service: schedules, housekeeping, orphaned recording requests."""
