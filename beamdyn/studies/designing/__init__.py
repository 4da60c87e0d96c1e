"""Inverse design: numbers of a scene with which its answers take wanted values."""
