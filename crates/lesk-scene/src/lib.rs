//! Scene files: text to data, all errors at once.
