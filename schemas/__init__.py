"""Messages, topics and their bytes on the bus. Imports no other package of tailor."""
