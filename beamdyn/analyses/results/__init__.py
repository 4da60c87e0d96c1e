"""How results of rotating beams are shown: tables, files, pictures, and cautions beside the numbers."""
