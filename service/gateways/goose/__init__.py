"""The GOOSE gateway: listens to relays' trips, and to signals that ask for a record."""
