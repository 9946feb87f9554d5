"""Tells the plant's state to an MQTT broker: as JSON on plain topics, and as a Sparkplug B edge node."""
