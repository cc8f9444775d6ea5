"""Record of what made an output: versions, config slice, fingerprint of the code, machine, time, seed."""
