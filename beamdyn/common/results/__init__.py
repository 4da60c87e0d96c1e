"""Parts of results: columns, statements, errors, display units; saving, loading, and one-line summaries."""
