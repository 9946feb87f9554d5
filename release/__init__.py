"""What a release needs: pinned packages, advisories about them, the bill of materials, the help pages."""
