"""What files, commands and screens share: units, descriptions of inputs, tables, reports, exit codes."""
