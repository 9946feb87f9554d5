"""One relay's records: listed, judged, pulled."""
