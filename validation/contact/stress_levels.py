"""Meshes of the benchmark of root stress, and which of their sizes are halved beside each."""

HALVED_SIZES = {
    "all": ("profile", "fillet_depth", "second_row", "width", "thickness"),
    "profile and depth": ("profile", "fillet_depth", "second_row"),
    "width": ("width",),
    "thickness": ("thickness",),
}
"""Element sizes that are halved for the finer mesh."""
OF_LEVEL = {"coarse": ("all",), "medium": ("profile and depth", "width", "thickness")}
"""Halvings that fit into memory; those of medium meshes one at a time."""
