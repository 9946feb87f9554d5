"""The one answer of a motor: which causes are likely, and what is not told apart."""
