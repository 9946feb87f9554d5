"""Parameters of motors followed while they run."""
