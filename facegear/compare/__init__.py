"""Two folders of results side by side: what moved, by how much, and what may have moved it."""
