"""The live page: from the bus to browsers."""
