"""Pages of recorded starts: those of one motor over its reference, and the latest of all motors."""
