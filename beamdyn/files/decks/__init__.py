"""Decks (other programs' input files on a blade): reading, checking, and conversion to scenes."""
