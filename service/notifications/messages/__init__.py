"""What a message says: as plain text, HTML, lines for a log, and a document for programs."""
