"""Scenes in TOML files: text with units in, core objects out, all mistakes in one message."""
