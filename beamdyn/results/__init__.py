"""How results of rotating beams are shown: tables, files, pictures, and what must stand beside the numbers."""
