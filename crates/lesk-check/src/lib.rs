//! Runs the claims of the models.
