"""The page of a motor's load: its profile, hours beyond limits, and how hot it is."""
