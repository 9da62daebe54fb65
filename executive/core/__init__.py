"""step(): the deterministic core of the executive. Clock, bus and random source stay outside."""
