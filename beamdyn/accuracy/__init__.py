"""Accuracy of results: refinement until a tolerance is met, and safety factors of estimated errors."""
