"""Processes of the service that are kept running: the parent's half and the child's."""
