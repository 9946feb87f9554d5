"""Recordings that somebody asked for."""
