"""Time as the service uses it: periodic work, pauses after failures, clocks, signs of life."""
