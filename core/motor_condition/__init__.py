"""The one condition of a motor: what is the matter with it, from all that its records tell, part by part."""
