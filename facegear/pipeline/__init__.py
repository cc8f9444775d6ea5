"""The stages as one table, and what follows from it: needs, rules, answers of the door, a page of docs."""
