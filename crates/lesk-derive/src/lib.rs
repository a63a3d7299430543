//! derive(Params): struct fields become a parameter table.
