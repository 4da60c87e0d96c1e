"""Parts without mechanics that both packages share: checks, results, units, tables, workers, pages."""
