"""Exact tooth surfaces of the pair: flanks, fillets, limits, unloaded contact."""
