"""Machines and tooth pairs in SI units from the sections of a config, with all checks across them."""
