"""Plots and mesh files of arrays; the modules do not depend on the analyses that compute the arrays."""
