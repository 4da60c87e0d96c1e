"""Shared by the interactive programs: descriptions of screens, forms, the state of a design, the page."""

HOME = "127.0.0.1"  # the address at which only this computer reaches a server
