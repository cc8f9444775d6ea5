"""Two folders of results side by side: what moved, by how much, and why it may have moved."""
