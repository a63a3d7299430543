//! Scattering models, each written once.
