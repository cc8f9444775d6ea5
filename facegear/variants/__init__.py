"""Machines beside that of the config: samples of its tolerances, designs, bins of a duty cycle."""
