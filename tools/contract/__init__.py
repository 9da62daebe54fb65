"""What every domain of a robot must keep to, and the pytest plug-in that tests it in anyone's repository."""
