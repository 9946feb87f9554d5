"""The simulated relay: recorder, protection, metering, and the server that offers them."""
