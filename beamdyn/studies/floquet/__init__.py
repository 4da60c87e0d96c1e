"""Stability of the beam in periodic motion, by Floquet theory: single points, and charts over two numbers."""
