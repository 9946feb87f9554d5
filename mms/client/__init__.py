"""The MMS client."""
