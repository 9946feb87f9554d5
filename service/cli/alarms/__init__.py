"""`mcc alarms`: what to act on first, and what people do about it."""
