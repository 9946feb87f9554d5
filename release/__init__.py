"""What is looked at and made for a release: pinned packages, advisories about them, the bill of materials."""
