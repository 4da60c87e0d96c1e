"""Scenes, the input of all analyses: beam, mount, motion and physics; immutable, validated, in SI units."""
