"""A Sparkplug B 3.0 edge node: its payloads, its metrics, and its life."""
