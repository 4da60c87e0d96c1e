"""Drawings and charts of brakes, as data and as matplotlib figures."""
