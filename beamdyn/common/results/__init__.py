"""What results are made of: columns, statements, errors, units of display; saved, loaded, and as one line."""
