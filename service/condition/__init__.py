"""The conditions of motors: each motor's records folded in their order of time, in the worker processes."""
