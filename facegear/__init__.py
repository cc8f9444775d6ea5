"""Face gear transmissions from tooth geometry to dynamic load sharing."""
