"""The settings of the service, and the credentials that it shows to relays."""
