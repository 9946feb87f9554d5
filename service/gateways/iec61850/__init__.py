"""The service as an IED: an IEC 61850 server that tells the health of the motors."""
