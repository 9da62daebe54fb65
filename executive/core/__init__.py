"""step(): the executive's pure core. No clock, no bus, no random source; all three come in as arguments."""
