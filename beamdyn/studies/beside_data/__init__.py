"""Measured data beside computed answers: pairs, deviations, their explanations, and identified numbers."""
