"""Modules shared by files, commands and forms: units, descriptions of inputs, tables, reports, exit codes."""
