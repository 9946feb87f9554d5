"""The recorded starts of motors, each beside the first ones."""
