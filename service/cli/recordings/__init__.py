"""Commands on recordings: diagnosed, commissioned from, uploaded and fetched."""
