"""BODY: simulated robots behind the driver contract. Never imports the executive."""
