"""Scenes from TOML files with units, and blades of other programs; all mistakes in one message."""
