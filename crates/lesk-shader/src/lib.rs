//! Shader source from the recorded formulas.
