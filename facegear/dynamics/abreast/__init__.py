"""Many machines of one structure run side by side: one in each lane of the processor's vectors."""
