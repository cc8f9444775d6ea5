"""Processor time of the dear stages against an earlier commit, both measured in turns in one run."""
