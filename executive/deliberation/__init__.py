"""What a tick advances within its budget: a source of plans; instantiation, assertion and refinement of its plan."""
