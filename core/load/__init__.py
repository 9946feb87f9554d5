"""How a motor is loaded over time: its load profile, its running hours, and hours beyond limits."""
