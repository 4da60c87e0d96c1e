"""Parts shared by files, commands and screens: units, descriptions of inputs, tables, reports, exit codes."""
