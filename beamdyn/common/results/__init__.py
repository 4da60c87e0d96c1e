"""Parts of results: columns, warnings, errors, display units; saving, loading, and one-line summaries."""
