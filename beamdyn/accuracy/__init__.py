"""Accuracy of answers: refinement to a tolerance, and margins of stated errors."""
