"""Stability of the beam in periodic motion, by Floquet theory: points, and charts over two numbers."""
