"""What made an output: versions, config slice, module fingerprint, machine, time, seed."""
