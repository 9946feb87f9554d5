"""Recordings: listed, brought, sent, drawn, diagnosed again and deleted."""
