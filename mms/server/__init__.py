"""The MMS server."""
