"""What attackers of the REST API cost the service: memory, CPU time, and time to answer others."""
