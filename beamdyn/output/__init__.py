"""Plots and exported files: from arrays, without knowledge of the analyses."""
