"""Decks, the input files of other programs for blades: read, audited, and written as scenes."""
