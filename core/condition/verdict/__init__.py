"""The condition as people read it: state, reasons and advice."""
