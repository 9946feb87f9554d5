"""Lists as files: which format a client wants, and the answer that is made while it is sent."""
