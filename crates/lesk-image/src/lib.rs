//! Film, filters, tone mapping and image files.
