"""Motors with a wound rotor: stator, rotor winding, and what is at the slip rings."""
