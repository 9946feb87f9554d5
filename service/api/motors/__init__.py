"""Sites and motors: their health and trends, baselines, and what their relays measure."""
