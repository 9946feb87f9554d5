"""`mcc notify`: what was sent to whom, tests of channels, and another attempt."""
