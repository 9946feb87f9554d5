"""The MMS client: one association with a relay, and the services over it."""
