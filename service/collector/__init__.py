"""The collector: gateway processes that talk MMS to the relays and fill the recording store."""
