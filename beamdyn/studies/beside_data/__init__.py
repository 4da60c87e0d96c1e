"""Comparison of measured data with computed results: pairs, deviations, explanations, identified numbers."""
