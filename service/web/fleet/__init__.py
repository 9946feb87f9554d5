"""The fleet: all motors of the plant on one page, those that need attention first."""
