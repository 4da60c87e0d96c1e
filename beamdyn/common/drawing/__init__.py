"""Drawings as data: shapes, arrows and labels in the machine's coordinates, drawn as SVG or by matplotlib."""
