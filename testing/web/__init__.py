"""A browser, pages that are watched for errors, and a seeded site for them."""
