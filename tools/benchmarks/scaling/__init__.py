"""What more workers gain."""
