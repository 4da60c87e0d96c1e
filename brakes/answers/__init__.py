"""What a command, a screen and a report all show of a brake: results, tables, drawings."""
