"""How well records that overlap are joined, and what a joined one tells of the rotor."""
