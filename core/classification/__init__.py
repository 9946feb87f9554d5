"""One answer from all that a record or a motor's records show: what is likely, and what is not told apart."""
