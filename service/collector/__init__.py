"""The collector: one process that talks MMS to the relays and fills the recording store."""
