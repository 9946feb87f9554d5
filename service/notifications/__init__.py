"""Tells people and programs of alarms: routes, messages, digests, and the threads that send them."""
