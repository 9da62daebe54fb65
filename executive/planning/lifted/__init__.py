"""Lifted planning: steps keep variables, and bindings grow as the plan does (Younes & Simmons 2003, section 2)."""
