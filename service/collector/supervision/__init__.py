"""Keeps the gateway processes running, and finds which relay brought one down."""
