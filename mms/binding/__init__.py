"""What touches C: the shared library, its prototypes, callbacks, values, and limits of time on its calls."""
