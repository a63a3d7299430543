//! Path tracing: scene to film.
