"""The MMS server: one simulated IED, and the thread that drives many."""
