"""Results as tables, for reading, and as rows of CSV files."""
