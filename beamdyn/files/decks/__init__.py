"""Blades of other programs: read, audited, and written as scenes."""
