"""The speed of a cage motor from its line currents: lines of its rotor's slots and of an eccentric rotor."""
