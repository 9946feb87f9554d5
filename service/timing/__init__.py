"""Time as the service uses it: periodic work, pauses after failures, trust in the wall clock."""
