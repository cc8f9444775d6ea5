"""The stages as one table, the functions behind it, and results that are known or stored."""
