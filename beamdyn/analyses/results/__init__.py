"""Presentation of results of rotating beams: tables, files, pictures, and warnings."""
