"""Contact over pose at full accuracy, measured once."""
