"""What the service tells Prometheus, made from the database at each scrape."""
