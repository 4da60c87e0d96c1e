"""Shared by the interactive programs: descriptions of screens, forms, the state of a design, the page."""
