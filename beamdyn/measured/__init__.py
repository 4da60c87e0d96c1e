"""Values from a laboratory or another program, as data: no mechanics."""
