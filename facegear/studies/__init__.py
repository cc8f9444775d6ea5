"""Many machines: samples of tolerances, designs of a search, and their statistics."""
