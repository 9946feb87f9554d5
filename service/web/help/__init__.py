"""The documentation under /help, and which passage of it explains what a page shows."""
