"""All that one record tells of its motor: found in one go, and kept, sent and shown as one object."""
