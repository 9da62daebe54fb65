"""HANDS: the command line. Imports everything; nothing imports it."""
