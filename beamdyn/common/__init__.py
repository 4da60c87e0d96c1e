"""Modules without mechanics that both packages share: checks, results, units, tables, processes, pages."""
