"""Vibration of a cantilever on a carrier that rotates and translates."""
__version__ = "0.1.0"
