"""`mcc`: the front door for people and scripts."""

from service.cli.app import main

__all__ = ["main"]
