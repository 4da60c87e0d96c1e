"""Plots and exported files of arrays, independent of the analyses."""
