"""The simulated relay: recorder, protection, and the server that offers them to clients."""
