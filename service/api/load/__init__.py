"""How motors were loaded, by what their relays meter."""
