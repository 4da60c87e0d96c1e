"""What knows no mechanics: checks, units, tables, stores."""
