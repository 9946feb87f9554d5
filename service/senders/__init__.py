"""Sends one message through one channel, in a limited time: mail, webhook, syslog, a command, Apprise."""
