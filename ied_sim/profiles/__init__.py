"""The relay profiles that come with the simulator: one TOML file each, and the ICD it names."""
