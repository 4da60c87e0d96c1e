"""Inverse design: numbers of a scene for which its results have required values."""
