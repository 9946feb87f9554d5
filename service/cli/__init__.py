"""The command line `mcc`, for people and scripts."""

from service.cli.app import main

__all__ = ["main"]
