"""Records of outputs: versions, slice of the config, fingerprint of the code, time, seed."""
