"""Stability of the beam in periodic motion, by Floquet theory: single scenes, and charts over two numbers."""
