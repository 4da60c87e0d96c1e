"""Shared by files, commands and screens: units, descriptions of inputs, tables, HTML reports, exit codes."""
