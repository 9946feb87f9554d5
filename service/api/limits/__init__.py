"""What clients may take of the service: connections and their time, bodies, uploads, long lists."""
