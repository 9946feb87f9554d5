"""One gateway process: which relays it holds, and one session for each."""
