"""The answers of a gearbox, chapter by chapter: functions of its case that `Gearbox` takes as methods."""
