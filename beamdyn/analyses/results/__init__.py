"""Presentation of results of rotating beams: tables, files, pictures, and cautions beside the numbers."""
