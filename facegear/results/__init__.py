"""Results of a gearbox: tables, figures and files of one stage each."""
