"""What a gearbox answers with: tables, figures and files of one stage each."""
