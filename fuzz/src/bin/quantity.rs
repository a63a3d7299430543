//! Fuzzes the reader of this name.
#![cfg_attr(fuzzing, no_main)]

lesk_fuzz::target!(quantity);
