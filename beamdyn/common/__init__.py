"""Parts without mechanics, shared by both packages: checks, results, units, tables, workers, pages."""
